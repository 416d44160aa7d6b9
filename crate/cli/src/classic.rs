//! The command line of RATS: `sinew [-/+options] FILE…` runs datasets and writes their pictures.
//!
//! A letter after `+` turns an option on, after `-` off; options with a value take it either way.
//! Each dataset is run by itself. Where RATS would go on reading commands from the keyboard, we
//! stop.

use crate::interludes::Interludes;
use crate::said::Said;
use crate::trace::{self, Wishes};
use crate::{Outcome, files, report, tools};
use rats::{Output, Severity};
use scene::Scene;
use std::ffi::OsStr;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Text that `-?` prints.
const HELP: &str = "\
sinew [-/+options] FILE.rat …     runs datasets as RATS did; + turns an option on, - off;
                                  the file - is the standard input
  -?           print this
  -d +d        tell how far the picture is (off)
  -e +e        echo the lines of the dataset (off)
  -i           print the version
  -j +j        jitter of rays
  -l FILE      log: write all that is said into a file as well
  -o FILE.fmt  name and format of the picture: png, tga, tif, gif or mtv;
               of several, those before the last are FILE-1.fmt, FILE-2.fmt, …
  -q           quit after the files, which is always done
  -r W H       width and height of the picture, pixels
  -s N         at most N×N rays a pixel
  -v +v        verbose: notes as well (on)
  -w +w        warnings (on)
sinew --help tells the other commands.";

/// The parsed options.
#[derive(Debug, Default)]
struct Request {
    files: Vec<PathBuf>,
    output: Option<PathBuf>,
    log: Option<PathBuf>,
    wishes: Wishes,
    progress: bool,
    echo: bool,
    quiet: bool,
    no_warnings: bool,
    help: bool,
    version: bool,
    /// Messages about options without a meaning here.
    remarks: Vec<String>,
}

/// Whether these arguments are in the manner of RATS: a dataset or a one-letter option comes first,
/// not one of the `subcommands`.
pub fn is_meant(arguments: &[String], subcommands: &[&str]) -> bool {
    let Some(first) = arguments.first() else {
        return false;
    };
    if subcommands.contains(&first.as_str()) || matches!(first.as_str(), "-h" | "-V") {
        return false;
    }
    let option = first.starts_with('+') || first.starts_with('-') && !first.starts_with("--");
    option || is_dataset(Path::new(first)) || Path::new(first).is_file()
}

/// Runs the datasets. False if one of them has errors or a job on pictures failed.
pub fn run(arguments: &[String]) -> Outcome {
    let request = parse(arguments)?;
    let mut said = Said::new(request.log.as_deref())?;
    for remark in &request.remarks {
        said.say(remark);
    }
    if request.help {
        println!("{HELP}");
    }
    if request.version {
        println!("sinew {}", env!("CARGO_PKG_VERSION"));
    }
    if request.files.is_empty() {
        return if request.help || request.version {
            Ok(true)
        } else {
            Err(String::from(
                "there is no dataset to run; name one, - to read one from the standard input, or \
                 see sinew -?",
            ))
        };
    }
    if let Some(output) = &request.output {
        trace::check_name(output)?;
        if request.files.len() > 1 {
            return Err(String::from(
                "-o names one picture, but there are several datasets; run them one by one",
            ));
        }
    }
    let mut clean = true;
    for file in &request.files {
        clean &= request.run_file(file, &mut said)?;
    }
    Ok(clean)
}

fn is_dataset(path: &Path) -> bool {
    path.file_name()
        .and_then(OsStr::to_str)
        .is_some_and(darkroom::name::is_dataset)
}

fn parse(arguments: &[String]) -> Result<Request, String> {
    let mut request = Request::default();
    let mut words = arguments.iter();
    while let Some(word) = words.next() {
        let on = word.starts_with('+');
        let option = word
            .strip_prefix(['-', '+'])
            .filter(|_| word != files::INPUT);
        let Some(letter) = option else {
            request.files.push(PathBuf::from(word));
            continue;
        };
        let mut value = |what: &str| {
            words
                .next()
                .map(String::as_str)
                .ok_or_else(|| format!("{word} needs {what}"))
        };
        match letter {
            "?" => request.help = true,
            "d" => request.progress = on,
            "e" => request.echo = on,
            "i" => request.version = true,
            "j" if on => request.remarks.push(String::from(
                "+j: rays are not jittered; the sampling grid stays regular",
            )),
            // They stop after the files, and do not jitter, anyway.
            "j" | "q" => {}
            "l" => request.log = Some(log_name(value("the name of a file")?)?),
            "o" => request.output = Some(PathBuf::from(value("the name of a picture")?)),
            "r" => {
                let width = number(word, value("a width and a height")?)?;
                request.wishes.size = Some([width, number(word, value("a width and a height")?)?]);
            }
            "s" => request.wishes.samples = Some(number(word, value("a number of rays")?)?),
            "v" => request.quiet = !on,
            "w" => request.no_warnings = !on,
            "a" | "c" | "g" | "t" | "y" => request.remarks.push(format!(
                "{word} changes nothing: it is about windows, and there are none here"
            )),
            "m" => request.remarks.push(format!(
                "{word} changes nothing: memory is not watched here"
            )),
            _ => return Err(format!("{word} is not an option; sinew -? lists them")),
        }
    }
    Ok(request)
}

fn number(option: &str, word: &str) -> Result<u32, String> {
    word.parse()
        .map_err(|_| format!("{option} takes whole numbers, not {word:?}"))
}

/// A forgotten name must not cost the dataset that follows `-l`.
fn log_name(word: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(word);
    if is_dataset(&path) {
        return Err(format!(
            "-l needs the name of a file for the log; {word} is a dataset and is not written over"
        ));
    }
    Ok(path)
}

impl Request {
    fn run_file(&self, file: &Path, said: &mut Said) -> Outcome {
        let mut loaded = files::load(file)?;
        if self.echo {
            said.say(echo(&loaded.project.files[0].text).trim_end());
        }
        let least = match (self.no_warnings, self.quiet) {
            (true, _) => Severity::Error,
            (false, true) => Severity::Warning,
            (false, false) => Severity::Note,
        };
        let messages = report::text(&loaded, least);
        said.say(messages.trim_end());
        let mut clean = report::is_clean(&loaded);
        let folder = file.parent().unwrap_or(Path::new(""));
        let compiled = &mut loaded.compiled;
        let interludes = std::mem::take(&mut compiled.interludes);
        let mut interludes = Interludes::new(interludes, folder, messages.trim_end());
        for (index, picture) in compiled.earlier.iter_mut().enumerate() {
            interludes.play(index, said)?;
            let name = self.output.as_ref();
            let name = name.map(|path| trace::number_name(path, index + 1));
            let scene = Arc::make_mut(&mut picture.scene);
            self.draw(scene, &picture.output, name.as_deref(), folder, said)?;
        }
        interludes.play(compiled.earlier.len(), said)?;
        // A text that only works on pictures has none of its own.
        if !compiled.scene.elements.is_empty() || compiled.tools.is_empty() {
            let scene = Arc::make_mut(&mut compiled.scene);
            let name = self.output.as_deref();
            self.draw(scene, &compiled.output, name, folder, said)?;
        }
        interludes.play(usize::MAX, said)?;
        for done in tools::carry_out(&compiled.tools, folder) {
            clean &= done.is_ok();
            said.say(&done.unwrap_or_else(|sentence| format!("sinew: {sentence}")));
        }
        said.close_log()?;
        Ok(clean)
    }

    /// Traces and writes a picture: under `name`, or in the dataset's folder as its text says.
    fn draw(
        &self,
        scene: &mut Scene,
        output: &Output,
        name: Option<&Path>,
        folder: &Path,
        said: &mut Said,
    ) -> Result<(), String> {
        if !output.saved && name.is_none() {
            said.say(
                "nosave is on: the picture is neither traced nor written (-o NAME asks for it)",
            );
            return Ok(());
        }
        let traced = self.wishes.trace(scene, &self.progress())?;
        let [width, height] = traced.picture.size();
        let wrote = match name {
            Some(path) => trace::write(path, &traced.picture)
                .map(|()| format!("wrote {}, {width}×{height}", path.display()))?,
            None => tools::save(folder, &output.file(), &traced.picture)?,
        };
        said.say(&format!("{wrote}, in {:.2} s", traced.seconds));
        Ok(())
    }

    /// Tells every tenth of the picture, if that was asked for.
    fn progress(&self) -> impl Fn(f64) + Sync {
        let told = AtomicU32::new(0);
        move |share| {
            let tenths = (share * 10.0) as u32;
            if self.progress && told.fetch_max(tenths, Ordering::Relaxed) < tenths {
                eprintln!("{tenths}0 %");
            }
        }
    }
}

/// The lines of a text that are echoed: commands without `@`, where `echo` is not off.
fn echo(text: &str) -> String {
    let mut echoed = String::new();
    let mut on = true;
    for line in text.lines() {
        let command = line.trim_start();
        let mut words = command.split([' ', '\t', ',']).filter(|w| !w.is_empty());
        let silent = command.is_empty() || command.starts_with(['@', '#']);
        if on && !silent {
            let _ = writeln!(echoed, "> {line}");
        }
        let opcode = words.next().unwrap_or_default().trim_start_matches('@');
        if opcode.eq_ignore_ascii_case("echo") {
            on = words
                .next()
                .is_none_or(|word| !word.eq_ignore_ascii_case("off"));
        }
    }
    echoed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<String> {
        line.split(' ').map(str::to_owned).collect()
    }

    #[test]
    fn options_are_told_from_subcommands() {
        for (line, meant) in [
            ("model.rat", true),
            ("MODEL.DAT", true),
            ("-q model.rat", true),
            ("+v", true),
            ("-", true),
            ("-? ", true),
            ("check model.rat", false),
            ("--help", false),
            ("--version", false),
            ("-h", false),
            ("chekc model.rat", false),
        ] {
            assert_eq!(is_meant(&words(line), &["check"]), meant, "{line}");
        }
        assert!(!is_meant(&[], &["check"]));
    }

    #[test]
    fn values_and_switches() {
        let request = parse(&words(
            "-r 640 480 a.rat -s 4 +e -v +w -o out.tga b.rat +d -q -j -l said.txt",
        ))
        .expect("understood");
        assert_eq!(request.files, [Path::new("a.rat"), Path::new("b.rat")]);
        assert_eq!(request.wishes.size, Some([640, 480]));
        assert_eq!(request.wishes.samples, Some(4));
        assert_eq!(request.output.as_deref(), Some(Path::new("out.tga")));
        assert_eq!(request.log.as_deref(), Some(Path::new("said.txt")));
        assert!(request.echo && request.quiet && request.progress && !request.no_warnings);
        assert!(request.remarks.is_empty());
    }

    #[test]
    fn nonsensical_options_are_errors() {
        let request = parse(&words("-a -c +g -t -y +m +j a.rat")).expect("understood");
        assert_eq!(request.remarks.len(), 7);
        for (line, why) in [
            ("-r 640", "needs a width"),
            ("-r 640 x", "whole numbers"),
            ("-s", "needs a number"),
            ("-s -1", "whole numbers"),
            ("-l model.rat", "not written over"),
            ("-o", "needs the name"),
            ("-z", "not an option"),
            ("-json", "not an option"),
        ] {
            let sentence = parse(&words(line)).map(|_| ()).expect_err(line);
            assert!(sentence.contains(why), "{line}: {sentence}");
        }
    }

    #[test]
    fn lines_are_echoed_as_in_the_text() {
        let text = "# head\n@reset all\n@echo off\nfov 50\necho on\n\nshoot # now\n";
        assert_eq!(echo(text), "> shoot # now\n");
        assert_eq!(echo("fov 50\necho off\nshoot\n"), "> fov 50\n> echo off\n");
    }
}
