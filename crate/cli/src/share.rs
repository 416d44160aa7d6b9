//! `sinew share` and `sinew open`: datasets to links and back.

use crate::{Outcome, files, report};
use clap::Args;
use rats::link::{self, Shared};
use std::path::PathBuf;

/// `sinew share FILE [--page ADDRESS]`.
#[derive(Args)]
pub struct Share {
    /// The dataset
    file: PathBuf,
    /// Address of the page, put before the `#`
    #[arg(long, default_value = "")]
    page: String,
}

impl Share {
    /// Prints the link. A dataset with errors can be shared all the same.
    pub fn run(&self) -> Outcome {
        let loaded = files::load(&self.file)?;
        let clean = report::to_stderr(&loaded);
        let shared = Shared {
            project: loaded.project,
            camera: None,
        };
        let fragment = link::encode(&shared).map_err(|error| error.to_string())?;
        for asset in &loaded.assets {
            eprintln!(
                "a link carries texts only: `{}` has to be opened in the page beside it",
                asset.name
            );
        }
        println!("{}#{fragment}", self.page);
        Ok(clean)
    }
}

/// `sinew open LINK [-o FOLDER]`.
#[derive(Args)]
pub struct Open {
    /// The link, or only what stands behind its `#`
    link: String,
    /// Write the texts into this folder; without it they are printed
    #[arg(short, long)]
    output: Option<PathBuf>,
}

impl Open {
    /// Prints or writes the texts. Existing files are never overwritten.
    pub fn run(&self) -> Outcome {
        let fragment = self
            .link
            .rsplit_once('#')
            .map_or(self.link.as_str(), |(_, fragment)| fragment);
        let shared = link::decode(fragment).map_err(|error| error.to_string())?;
        let Some(folder) = &self.output else {
            let several = shared.project.files.len() > 1;
            for file in &shared.project.files {
                if several {
                    println!("# ---- {} ----", file.name);
                }
                print!("{}", file.text);
                if !file.text.ends_with('\n') {
                    println!();
                }
            }
            return Ok(true);
        };
        std::fs::create_dir_all(folder)
            .map_err(|error| format!("cannot make {}: {error}", folder.display()))?;
        for file in &shared.project.files {
            // A stranger's link must not choose a place outside the folder.
            let name = std::path::Path::new(&file.name)
                .file_name()
                .ok_or_else(|| {
                    format!(
                        "the link carries a file without a usable name: {:?}",
                        file.name
                    )
                })?;
            let path = folder.join(name);
            let mut target = std::fs::File::create_new(&path)
                .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
            std::io::Write::write_all(&mut target, file.text.as_bytes())
                .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
            eprintln!("wrote {}", path.display());
        }
        Ok(true)
    }
}
