//! Figures and tables as files.
use cylwatch::report::Provenance;
use cylwatch::report::figure::{Figure, Horizontal, Item, Mark, Panel, style};

fn provenance() -> Provenance {
    Provenance { command: "cylwatch simulate 'a & b' --plot x.svg".into(), inputs: vec![], seed: None }
}

fn example() -> Figure {
    let x: Vec<f64> = (0..=600).map(|k| f64::from(k) * 18.0).collect();
    let toward = |from: f64, to: f64, tau: f64| {
        x.iter().map(move |t| to + (from - to) * (-t / tau).exp()).collect::<Vec<f64>>()
    };
    let temperatures = vec![
        Item::line("air", &x, x.iter().map(|&t| if t < 600.0 { 21.0 } else { -25.0 }), style::AIR),
        Item::line("shoulder", &x, toward(21.0, -25.0, 1500.0), style::SHOULDER),
        Item::line("wall, middle", &x, toward(21.0, -25.0, 1800.0), style::WALL_MIDDLE),
        Item::line("wall, bottom", &x, toward(21.0, -25.0, 2000.0), style::WALL_BOTTOM),
        Item::line("valve", &x, toward(21.0, -25.0, 900.0), style::VALVE),
        Item::line("gas, mean", &x, toward(21.0, -25.0, 2300.0), style::GAS_MEAN),
    ];
    let pressure = vec![
        Item::line("pressure", &x, toward(206.0, 160.09, 2300.0), style::PRESSURE),
        Item::Limit { name: "limit 160 bar".into(), value: 160.0 },
    ];
    Figure {
        title: "shock-cold on nitrogen-20l".into(),
        horizontal: Horizontal::Time,
        panels: vec![
            Panel { quantity: "temperature in °C".into(), items: temperatures, height: 1.2 },
            Panel { quantity: "pressure in bar".into(), items: pressure, height: 0.8 },
        ],
        marks: vec![
            Mark { at: 3600.0, name: "leak opens".into() },
            Mark { at: 9000.0, name: "below 160 bar".into() },
        ],
        below: None,
    }
}

#[test]
fn a_figure_becomes_a_png_of_twice_its_size() {
    let bytes = example().to_png(&provenance()).unwrap();
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let width = u32::from_be_bytes(bytes[16..20].try_into().unwrap());
    assert_eq!(width, 2 * style::WIDTH as u32);
    if let Some(folder) = std::env::var_os("CYLWATCH_LOOK") {
        std::fs::write(std::path::Path::new(&folder).join("example.png"), bytes).unwrap();
    }
}

#[test]
fn a_figure_becomes_an_svg_with_every_name_and_unit() {
    let text = example().to_svg(&provenance()).unwrap();
    assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
    for words in
        ["temperature in °C", "pressure in bar", "time in min", "limit 160 bar", "gas, mean", "leak opens"]
    {
        assert!(text.contains(words), "{words} is missing");
    }
    assert_eq!(text.matches("<svg").count(), 1);
}
