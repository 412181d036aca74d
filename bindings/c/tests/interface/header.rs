//! The header is what the code says.
use std::path::Path;

#[test]
fn the_header_is_that_of_the_code() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).unwrap();
    let mut made = Vec::new();
    cbindgen::Builder::new().with_crate(folder).with_config(config).generate().unwrap().write(&mut made);
    let made = String::from_utf8(made).unwrap();
    let path = folder.join("include/cylwatch.h");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap();
    assert!(
        kept == made,
        "include/cylwatch.h is not that of the code: UPDATE=1 cargo test -p cylwatch-c header"
    );
}

#[test]
fn every_code_has_words_of_its_own() {
    let text = |code| unsafe { std::ffi::CStr::from_ptr(cylwatch_c::cw_error_text(code)) }.to_str().unwrap();
    let texts: std::collections::HashSet<&str> = (0..=22).map(text).collect();
    assert_eq!(texts.len(), 23);
    assert_eq!(cylwatch_c::code::cw_code::CW_PANICKED as i32, 22);
    for none in [-1, 23, i32::MIN, i32::MAX] {
        assert_eq!(text(none), "there is no such code");
    }
}
