//! A server for this machine.

use crate::page::{self, Build};
use anyhow::{Result, anyhow};
use std::path::{Component, Path};
use tiny_http::{Header, Method, Request, Response, Server};

/// The port that is tried first.
const PORT: u16 = 8080;

/// Builds the page and serves it until the program is ended. Enter builds it anew.
pub fn serve(port: Option<u16>, release: bool) -> Result<()> {
    let build = if release {
        Build::Release
    } else {
        Build::Development
    };
    let folder = page::serve_folder();
    page::build(build, &folder)?;
    let mut server = Server::http(("127.0.0.1", port.unwrap_or(PORT)));
    if server.is_err() && port.is_none() {
        server = Server::http(("127.0.0.1", 0));
    }
    let server = server.map_err(|error| {
        anyhow!("The port cannot be used: {error}. Choose another one with --port.")
    })?;
    let address = server.server_addr();
    println!("\nSinew is at http://{address}/ (Enter builds it anew, Ctrl+C ends it)");
    let served = folder.clone();
    std::thread::spawn(move || {
        for request in server.incoming_requests() {
            // The browser may have gone away; that is no reason to end.
            let _ = answer(&served, request);
        }
    });
    let mut line = String::new();
    while std::io::stdin().read_line(&mut line)? > 0 {
        match page::build(build, &folder) {
            Ok(()) => println!("Built. Reload the page."),
            Err(error) => eprintln!("xtask: {error:#}"),
        }
    }
    // Without a terminal there is no Enter.
    loop {
        std::thread::park();
    }
}

fn answer(folder: &Path, request: Request) -> std::io::Result<()> {
    if !matches!(request.method(), Method::Get | Method::Head) {
        return request.respond(Response::empty(405));
    }
    let path = request.url().split(['?', '#']).next().unwrap_or_default();
    let path = Path::new(path.trim_start_matches('/')).to_owned();
    let inside = path
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    let path = folder.join(if path.as_os_str().is_empty() {
        "index.html".into()
    } else {
        path
    });
    let Some(bytes) = inside.then(|| std::fs::read(&path).ok()).flatten() else {
        return request.respond(Response::from_string("Not found.").with_status_code(404));
    };
    let mut response = Response::from_data(bytes);
    for (name, value) in [("Content-Type", mime(&path)), ("Cache-Control", "no-store")] {
        if let Ok(header) = Header::from_bytes(name, value) {
            response.add_header(header);
        }
    }
    request.respond(response)
}

fn mime(path: &Path) -> &'static str {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("webmanifest") => "application/manifest+json",
        Some("css") => "text/css; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("rat") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}
