//! What a log holds, as text for a terminal and as JSON.
mod document;
mod text;

pub(crate) use document::document;
pub(crate) use text::{summary, text};

#[cfg(test)]
mod tests {
    use crate::log::LogOptions;
    use crate::log::inspect::Inspector;

    proptest::proptest! {
        #[test]
        fn no_bytes_make_the_inspection_panic(
            bytes in proptest::collection::vec(proptest::prelude::any::<u8>(), 0..300),
            cells in "([0-9.,;:/ \\n-]|Zeit|bar|\\[|\\]|T1){0,80}",
            begin in 0_usize..5,
        ) {
            let begins: [&[u8]; 5] =
                [b"", b"time_s,shoulder_degc\n0,15\n", b"Datum;Zeit;T [\xb0C]\n22.11.2026;14:05;1,5\n", b"x;y\n;bar\n", b"a,b\n1,2\n"];
            for tail in [&bytes[..], cells.as_bytes()] {
                let text = [begins[begin], tail].concat();
                let opened = Inspector::new(Box::new(std::io::Cursor::new(text)), "soup", &LogOptions::default());
                if let Ok(mut inspector) = opened {
                    while let Ok(true) = inspector.step() {}
                    let _ = super::text(&inspector.finish());
                }
            }
        }
    }
}
