//! The program under test, folders to run it in, and what it answers.

use proptest::test_runner::{Config as ProptestConfig, RngSeed};
use serde_json::Value;
use std::fs::{self, File};
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The program.
pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_pointmass");

/// How long any run may take before it counts as hanging.
const PATIENCE: Duration = Duration::from_secs(240);

/// What a run of the program came to.
#[derive(Debug)]
pub(crate) struct Answer {
    /// The exit code; -1 if a signal ended it.
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Answer {
    /// The same, which has to have gone well and without a word on standard error.
    #[track_caller]
    pub(crate) fn fine(self) -> Self {
        assert_eq!((self.code, self.stderr.as_str()), (0, ""), "{self:?}");
        self
    }

    /// The lines of standard error, of a run that went well; all have to be warnings.
    #[track_caller]
    pub(crate) fn warnings(&self) -> Vec<&str> {
        assert_eq!(self.code, 0, "{self:?}");
        let strip = |line| str::strip_prefix(line, "warning: ");
        self.stderr.lines().map(|line| strip(line).unwrap_or_else(|| panic!("no warning: {line}"))).collect()
    }

    /// The error of a run that failed as runs have to: exit code 1, one line on standard error, nothing on the other.
    #[track_caller]
    pub(crate) fn error(&self) -> &str {
        let line = self.stderr.strip_prefix("error: ").and_then(|rest| rest.strip_suffix('\n'));
        let line = line.filter(|line| !line.contains('\n') && !line.contains("panicked"));
        assert_eq!((self.code, self.stdout.as_str()), (1, ""), "{self:?}");
        line.unwrap_or_else(|| panic!("not one line that begins with `error: `: {self:?}"))
    }

    /// The report of a run with `--report json`.
    #[track_caller]
    pub(crate) fn report(&self) -> Value {
        assert_eq!(self.code, 0, "{self:?}");
        assert_eq!(self.stdout.lines().count(), 1, "{self:?}");
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}", self.stdout))
    }
}

/// A number of a report, by its path: `died/sink`.
#[track_caller]
pub(crate) fn number(report: &Value, path: &str) -> f64 {
    report.pointer(&format!("/{path}")).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {path} in {report}"))
}

/// A folder to run the program in; it is gone when dropped.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for the test"))
    }

    /// A folder with one file.
    pub(crate) fn with(name: &str, content: impl AsRef<[u8]>) -> Self {
        let folder = Self::new();
        folder.write(name, content);
        folder
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, and the folders around it.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("the folder can be made");
        fs::write(path, content).expect("the file can be written");
    }

    #[track_caller]
    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// All files and folders in it, hidden ones too, in order.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        list(self.0.path(), self.0.path(), &mut names);
        names.sort();
        names
    }

    /// Runs the program with arguments that have no blanks in them.
    #[track_caller]
    pub(crate) fn run(&self, args: &str) -> Answer {
        self.command(Command::new(PROGRAM).args(args.split_whitespace()))
    }

    /// Runs the program with these arguments.
    #[track_caller]
    pub(crate) fn run_with(&self, args: &[&str]) -> Answer {
        self.command(Command::new(PROGRAM).args(args))
    }

    /// Runs a command with arguments that it does not take; each time it has to say what it expects.
    #[track_caller]
    pub(crate) fn misuse(&self, command: &str, cases: &[(&str, &str)]) {
        for (args, expected) in cases {
            let answer = self.run(&format!("{command} {args}"));
            assert_eq!(answer.code, 2, "{args}: {answer:?}");
            assert!(answer.stderr.contains(expected), "{args}: {expected} in {}", answer.stderr);
        }
    }

    /// The report of a run that goes well and without a warning.
    #[track_caller]
    pub(crate) fn report(&self, args: &str) -> Value {
        self.run(&format!("run {args} --report json")).fine().report()
    }

    /// The hash of such a run.
    #[track_caller]
    pub(crate) fn hash(&self, args: &str) -> String {
        self.report(args)["hash"].as_str().expect("a hash").to_string()
    }

    /// Runs a script of the shell, in which `$POINTMASS` is the program.
    #[cfg(unix)]
    #[track_caller]
    pub(crate) fn shell(&self, script: &str) -> Answer {
        self.command(Command::new("sh").args(["-c", script]).env("POINTMASS", PROGRAM))
    }

    /// Runs a command here; what it says goes to files, so that it cannot wait for somebody to read it.
    #[track_caller]
    fn command(&self, command: &mut Command) -> Answer {
        let [mut out, mut err] = [(); 2].map(|()| tempfile::tempfile().expect("a file for what it says"));
        let twin = |file: &File| Stdio::from(file.try_clone().expect("a handle"));
        command.current_dir(self.0.path()).stdin(Stdio::null()).stdout(twin(&out)).stderr(twin(&err));
        let mut child = command.spawn().expect("the program starts");
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().expect("it can be waited for") {
                break status;
            }
            if begun.elapsed() > PATIENCE {
                child.kill().expect("it can be ended");
                panic!("{command:?} still runs after {PATIENCE:?}");
            }
            std::thread::sleep(Duration::from_millis(1));
        };
        Answer { code: status.code().unwrap_or(-1), stdout: said(&mut out), stderr: said(&mut err) }
    }
}

fn said(file: &mut File) -> String {
    let mut text = String::new();
    file.rewind().and_then(|()| file.read_to_string(&mut text)).expect("what it says is text");
    text
}

fn list(root: &Path, folder: &Path, names: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            list(root, &path, names);
        }
        names.push(path.strip_prefix(root).expect("inside").to_string_lossy().into_owned());
    }
}

/// How random scenes are tried: `cases` of them, fewer in debug builds, always the same ones; but `PROPTEST_CASES=N` asks
/// for N others.
pub(crate) fn tries(cases: usize) -> ProptestConfig {
    let defaults = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    if std::env::var_os("PROPTEST_CASES").is_some() {
        return defaults;
    }
    ProptestConfig { cases: often(cases) as u32, rng_seed: RngSeed::Fixed(1), ..defaults }
}

/// A loop's length: `n`, or a tenth of that in debug builds.
pub(crate) const fn often(n: usize) -> usize {
    if cfg!(debug_assertions) { n.div_ceil(10) } else { n }
}
