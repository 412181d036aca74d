//! Figures and tables as files.
use cylwatch::report::Provenance;
use cylwatch::report::figure::{Arrow, Diagram, Figure, Form, Item, Mark, Node, Panel, Part, Picture, style};

fn provenance() -> Provenance {
    Provenance { command: "cylwatch simulate 'a & b' --plot x.svg".into(), inputs: vec![], seed: None }
}

fn example() -> Picture {
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
    let panels = vec![
        Panel::new("temperature in °C", 1.2, temperatures),
        Panel::new("pressure in bar", 0.8, pressure),
    ];
    let marks = vec![
        Mark { at: 3600.0, name: "leak opens".into() },
        Mark { at: 9000.0, name: "below 160 bar".into() },
    ];
    Figure::over_time("shock-cold on nitrogen-20l", panels).with_marks(marks).into()
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

/// The tag before a text of an SVG.
fn tag<'a>(svg: &'a str, words: &str) -> &'a str {
    let end = svg.find(&format!("\n{words}\n")).unwrap_or_else(|| panic!("{words} is missing"));
    let begin = svg[..end].rfind("<text").unwrap();
    &svg[begin..end]
}

#[test]
fn a_limit_is_named_where_no_curve_passes() {
    let named = |from: f64, to: f64| {
        let x: Vec<f64> = (0..=100).map(f64::from).collect();
        let values = |less: f64| x.iter().map(move |t| if *t < 50.0 { from - less } else { to - less });
        let items = vec![
            Item::line("pressure", &x, values(0.0), style::PRESSURE),
            Item::line("lower", &x, values(10.0), style::PRESSURE),
            Item::line("floor", &x, x.iter().map(|_| 100.0), style::AIR),
            Item::line("top", &x, x.iter().map(|_| 220.0), style::GAS_MEAN),
            Item::Limit { name: "the limit".into(), value: 160.0 },
        ];
        let figure = Figure::over_time("t", vec![Panel::new("pressure in bar", 1.0, items)]);
        Picture::from(figure).to_svg(&provenance()).unwrap()
    };
    // Two curves that cover the places above and below the line on their half.
    let (right, left) = (named(110.0, 165.0), named(165.0, 110.0));
    let end = |svg: &str| {
        let tag = tag(svg, "the limit");
        assert!(tag.contains("text-anchor=\"end\""), "{tag}");
        tag.split_once(" x=\"").unwrap().1.split('"').next().unwrap().parse::<f64>().unwrap()
    };
    let middle = 2.0 * style::WIDTH;
    assert!(end(&right) < middle && middle < end(&left), "{} {}", end(&right), end(&left));
}

#[test]
fn an_arrow_of_a_diagram_points_to_the_block_that_it_goes_to() {
    let node = |words: &str, at| Node { words: words.into(), at, form: Form::Box };
    let arrow = |from, to| Arrow { from, to, signal: String::new(), sign: None };
    let drawn = |arrow| {
        let diagram = Diagram {
            title: "t".into(),
            nodes: vec![node("here", (0.0, 0.0)), node("right", (1.0, 0.0)), node("below", (0.0, 1.0))],
            arrows: vec![arrow],
        };
        Picture { title: "t".into(), parts: vec![Part::Diagram(diagram)] }.to_svg(&provenance()).unwrap()
    };
    // Tip first, then the other two corners.
    let head = |svg: &str| -> Vec<[f64; 2]> {
        let points = svg.split("<polygon").nth(1).unwrap().split("points=\"").nth(1).unwrap();
        let pair = |point: &str| {
            let (x, y) = point.split_once(',').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        };
        points.split('"').next().unwrap().split_whitespace().map(pair).collect()
    };
    let right = head(&drawn(arrow(0, 1)));
    assert!(right[0][0] > right[1][0] && right[1][0] == right[2][0], "{right:?}");
    let down = head(&drawn(arrow(0, 2)));
    assert!(down[0][1] > down[1][1] && down[1][1] == down[2][1], "{down:?}");
    let up = head(&drawn(arrow(2, 0)));
    assert!(up[0][1] < up[1][1], "{up:?}");
    // Tips are at the near edge of the block: below the words of the upper one, above those of the lower one.
    let line = |words: &str| -> f64 {
        let svg = drawn(arrow(0, 2));
        let y = tag(&svg, words).split(" y=\"").nth(1).unwrap();
        y.split('"').next().unwrap().parse().unwrap()
    };
    assert!(up[0][1] > line("here") && down[0][1] < line("below"), "{up:?} {down:?}");
}
