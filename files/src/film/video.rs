//! Videos, which ffmpeg packs.

use super::Film;
use super::common::{cannot_write, no_frames};
use super::yuv::Yuv;
use crate::outcome::{Failure, Outcome};
use crate::whole::WholeFile;
use image::RgbImage;
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};

/// The program that packs them, found where programs are.
const PROGRAM: &str = "ffmpeg";

/// How it is to pack pictures, and what they are packed into.
#[derive(Clone, Copy, Debug)]
pub(super) enum Packing {
    /// H.264 in MP4.
    Mp4,
    /// VP9 in WebM.
    Webm,
}

impl Packing {
    fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Mp4 => &["-c:v", "libx264", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"],
            Self::Webm => &["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"],
        }
    }
}

/// A video in the making. Dropped, it is gone, and so is the program.
#[derive(Debug)]
pub(super) struct Video {
    file: WholeFile,
    fps: f64,
    program: Program,
    /// Nothing before the first picture, which gives the video its size.
    reel: Option<Yuv<ChildStdin>>,
}

/// A program that runs, and is ended if nobody waits for it any more.
#[derive(Debug)]
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Video {
    pub(super) fn create(path: &Path, fps: f64, packing: Packing) -> Outcome<Self> {
        let file = WholeFile::create(path)?;
        let program = start(file.passing(), packing).map_err(|error| match error.kind() {
            ErrorKind::NotFound => cannot_write(
                path,
                "the program ffmpeg packs videos and is not installed; install it, or write .gif, .apng or .y4m, which need no \
                 other program",
            ),
            _ => cannot_write(path, format!("{PROGRAM}: {error}")),
        })?;
        Ok(Self { file, fps, program: Program(program), reel: None })
    }

    fn add(&mut self, frame: &RgbImage) -> io::Result<()> {
        if self.reel.is_none() {
            let pipe = self.program.0.stdin.take().ok_or(ErrorKind::BrokenPipe)?;
            self.reel = Some(Yuv::begin(pipe, frame, self.fps)?);
        }
        self.reel.as_mut().map_or(Ok(()), |reel| reel.push(frame))
    }

    /// The sentence for what the program says before it ends, of which the last line tells most.
    fn complaint(&mut self) -> Failure {
        let mut said = Vec::new();
        if let Some(mut errors) = self.program.0.stderr.take() {
            // What cannot be read is not said.
            let _ = errors.read_to_end(&mut said);
        }
        let said = String::from_utf8_lossy(&said);
        let why = said.trim().lines().last().unwrap_or("it ended and did not say why");
        cannot_write(self.file.path(), format!("{PROGRAM}: {why}"))
    }
}

impl Film for Video {
    fn push(&mut self, frame: &RgbImage) -> Outcome {
        self.add(frame).map_err(|error| match error.kind() {
            // It has ended, and has said why.
            ErrorKind::BrokenPipe => self.complaint(),
            _ => cannot_write(self.file.path(), error),
        })
    }

    fn finish(mut self: Box<Self>) -> Outcome {
        // With its end of the pipe closed the program comes to an end.
        if self.reel.take().is_none() {
            return Err(no_frames(self.file.path()));
        }
        let complaint = self.complaint();
        let Self { file, mut program, .. } = *self;
        match program.0.wait() {
            Ok(status) if status.success() => file.complete(),
            Ok(_) => Err(complaint),
            Err(error) => Err(cannot_write(file.path(), error)),
        }
    }
}

/// Starts the program, which is going to write `path`.
fn start(path: &Path, packing: Packing) -> io::Result<Child> {
    // Every player knows pictures with an even number of rows and columns, with half as many of colour.
    let even = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=in_range=full:out_range=tv,format=yuv420p";
    let mut command = Command::new(PROGRAM);
    command.args(["-hide_banner", "-loglevel", "error", "-y", "-f", "yuv4mpegpipe", "-i", "-", "-vf", even]);
    command.args(packing.arguments()).arg(path);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn()
}
