//! Without an operating system nothing can go on after a panic: an arena that was full, or a mistake in here.
use core::panic::PanicInfo;

unsafe extern "C" {
    /// To be written by whoever links the library: stops the machine or starts it anew, and does not return.
    fn cw_panicked() -> !;
}

#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    // SAFETY: the function takes nothing and does not return.
    unsafe { cw_panicked() }
}
