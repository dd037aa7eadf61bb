//! What a page lends WebAssembly in place of semihosting.

use core::fmt::{self, Write};

/// Lines for whoever runs it.
pub(crate) struct Lines;

impl Write for Lines {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        // SAFETY: the page only reads these bytes of the module's memory, before it returns.
        unsafe { host::print(text.as_ptr(), text.len()) };
        Ok(())
    }
}

macro_rules! println {
    ($($line:tt)*) => {{
        use core::fmt::Write as _;
        // It cannot fail.
        let _ = writeln!($crate::page::Lines, $($line)*);
    }};
}
pub(crate) use println;

pub(crate) mod process {
    /// Ends the program.
    pub(crate) fn exit(code: i32) -> ! {
        // SAFETY: the page throws, and nothing of the module runs any more.
        unsafe { super::host::exit(code) }
    }
}

mod host {
    #[link(wasm_import_module = "host")]
    unsafe extern "C" {
        pub(super) fn print(text: *const u8, len: usize);
        pub(super) fn exit(code: i32) -> !;
    }
}
