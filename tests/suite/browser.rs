//! Reports of all commands, and how a real browser shows them.
//!
//! With Chromium or Chrome on the path (or named by `CYLWATCH_BROWSER`) each report is opened on a desk and on a phone: nothing is
//! loaded from elsewhere, nothing is wider than the window, every picture has a size, no label of a picture lies over another one, over a curve, or over the edge.
//! Without one this is skipped with a message. `CYLWATCH_LOOK=DIR` keeps the reports.
use crate::support::{Outcome, TINY_PLAN, reproduced, run};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::tempdir;

/// What a browser found on a page.
#[derive(Debug, serde::Deserialize)]
struct Seen {
    title: String,
    window: f64,
    wide: f64,
    headings: usize,
    rows: usize,
    pictures: Vec<f64>,
    unnamed: usize,
    loaded: usize,
    covered: Vec<String>,
}

/// Frames the report, looks at it when it is there, and leaves what was found as the text of the page.
const LOOK: &str = r##"<!doctype html><meta charset="utf-8"><body style="margin:0">
<iframe id="f" src="REPORT" style="border:0;width:WIDTHpx;height:900px"></iframe><pre id="seen"></pre><script>
const frame = document.getElementById('f');
frame.onload = () => {
  const d = frame.contentDocument, w = frame.contentWindow, covered = [];
  for (const svg of d.querySelectorAll('figure svg')) {
    if (!svg.getBoundingClientRect().height) continue;
    const texts = [...svg.querySelectorAll('text')].map(t => [t.textContent.trim(), t.getBoundingClientRect()]);
    for (let i = 0; i < texts.length; i++) for (let j = i + 1; j < texts.length; j++) {
      const a = texts[i][1], b = texts[j][1];
      const x = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      // A text's box is higher than its letters.
      if (x > 1 && y > 0.45 * Math.min(a.height, b.height)) covered.push(texts[i][0] + ' | ' + texts[j][0]);
    }
    const sheet = svg.getBoundingClientRect(), scale = sheet.width / svg.viewBox.baseVal.width;
    for (const [words, box] of texts)
      if (box.left < sheet.left - 1 || box.right > sheet.right + 1) covered.push(words + ' | edge');
    // Lines of the grid may pass below a text, curves may not.
    for (const line of svg.querySelectorAll('polyline:not([stroke="#DEDEDE"])')) {
      const points = [...line.points].map(p => [sheet.left + scale * p.x, sheet.top + scale * p.y]);
      for (const [words, box] of texts) {
        const [top, bottom] = [box.top + 0.3 * box.height, box.bottom - 0.3 * box.height];
        const inside = ([x, y]) => x > box.left + 1 && x < box.right - 1 && y > top && y < bottom;
        const crossed = points.some((b, k) => {
          const a = points[Math.max(k - 1, 0)], steps = 1 + Math.ceil(Math.hypot(b[0] - a[0], b[1] - a[1]));
          for (let n = 0; n <= steps; n++)
            if (inside([a[0] + n / steps * (b[0] - a[0]), a[1] + n / steps * (b[1] - a[1])])) return true;
        });
        // A white field below the text hides the curve.
        const fields = [...svg.querySelectorAll('rect[fill="#FFFFFF"]')].map(f => f.getBoundingClientRect());
        const hidden = fields.some(f => f.height < 2 * box.height && f.left <= box.left + 3 && f.right >= box.right - 3 &&
          f.top < top && f.bottom > bottom);
        if (crossed && !hidden && !covered.includes(words + ' | curve')) covered.push(words + ' | curve');
      }
    }
  }
  document.getElementById('seen').textContent = JSON.stringify({
    title: d.title, window: w.innerWidth, wide: d.documentElement.scrollWidth,
    headings: d.querySelectorAll('h1,h2').length, rows: d.querySelectorAll('tr').length,
    pictures: [...d.querySelectorAll('figure svg')].map(s => s.getBoundingClientRect().height).filter(h => h > 0),
    unnamed: [...d.querySelectorAll('figure svg')].filter(s => !(s.getAttribute('aria-label') || '').length).length,
    loaded: w.performance.getEntriesByType('resource').length, covered });
};
</script>"##;

/// Chromium or Chrome, if there is one.
fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CYLWATCH_BROWSER") {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// Opens a report in a window of a width.
fn seen(browser: &Path, report: &Path, width: u32) -> Seen {
    let folder = report.parent().unwrap();
    let name = report.file_name().unwrap().to_str().unwrap();
    let frame = folder.join(format!("look-{width}-{name}"));
    std::fs::write(&frame, LOOK.replace("REPORT", name).replace("WIDTH", &width.to_string())).unwrap();
    let profile = tempdir().unwrap();
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
        .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
        .args(["--allow-file-access-from-files", "--virtual-time-budget=20000", "--dump-dom"])
        .args(["--host-resolver-rules=MAP * ~NOTFOUND", "--window-size=1400,1000"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}", frame.display()))
        .output()
        .unwrap();
    let page = String::from_utf8(output.stdout).unwrap();
    let found = page.split("<pre id=\"seen\">").nth(1).and_then(|rest| rest.split("</pre>").next());
    let found = found
        .unwrap_or_else(|| panic!("the browser showed no page: {}", String::from_utf8_lossy(&output.stderr)));
    let found = found.replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">");
    serde_json::from_str(&found).unwrap_or_else(|error| panic!("{name}: {error} in {found}"))
}

/// Makes the reports of all commands in a folder; their names.
fn reports(folder: &Path) -> Vec<&'static str> {
    let ran = |arguments: &[&str], codes: &[i32]| {
        let Outcome { code, stderr, .. } = run(folder, arguments);
        assert!(code.is_some_and(|code| codes.contains(&code)), "{arguments:?}: {stderr}");
    };
    let n = "nitrogen-20l";
    ran(&["simulate", n, "tunnel-winter", "-o", "run.csv", "--report", "simulate.html"], &[0]);
    ran(&["inspect", "run.csv", "-o", "inspection.txt", "--report", "inspect.html"], &[0]);
    ran(&["estimate", n, "run.csv", "-o", "est.csv", "--report", "estimate.html"], &[0]);
    ran(&["monitor", n, "run.csv", "-o", "rows.csv", "--report", "monitor.html"], &[0, 1, 3]);
    // Pressures swing across a limit: its name must find a place.
    ran(&["simulate", n, "railway-week", "-o", "week.csv"], &[0]);
    ran(
        &["monitor", n, "week.csv", "--limit-bar", "190", "-o", "week-rows.csv", "--report", "week.html"],
        &[0, 1, 3],
    );
    let fill = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"];
    ran(&[&["inspection", n, "run.csv"], &fill[..], &["--report", "inspection.html"]].concat(), &[0]);
    let columns = ["--input", "shoulder", "--output", "gas_mean"];
    ran(&[&["identify", "run.csv"], &columns[..], &["--report", "identify.html"]].concat(), &[0]);
    ran(&["calibrate", n, "run.csv", "--scenario", "tunnel-winter", "--report", "calibrate.html"], &[0]);
    ran(&["place", n, "--sensors", "2", "--scenario", "none", "--report", "place.html"], &[0]);
    std::fs::write(folder.join("tiny.toml"), TINY_PLAN).unwrap();
    ran(&["bench-detector", "tiny.toml", "--report", "bench-detector.html"], &[0]);
    let state = ["--temperature-degc", "15", "--pressure-bar", "200"];
    ran(&[&["properties", "nitrogen"], &state[..], &["--report", "properties.html"]].concat(), &[0]);
    std::fs::copy(reproduced().0.path().join("reproduce.html"), folder.join("reproduce.html")).unwrap();
    vec![
        "simulate.html",
        "inspect.html",
        "estimate.html",
        "monitor.html",
        "week.html",
        "inspection.html",
        "identify.html",
        "calibrate.html",
        "place.html",
        "bench-detector.html",
        "properties.html",
        "reproduce.html",
    ]
}

#[test]
fn every_command_writes_a_report_that_a_browser_shows_on_a_desk_and_on_a_phone() {
    let folder = tempdir().unwrap();
    let folder = folder.path().canonicalize().unwrap();
    let names = reports(&folder);
    for name in &names {
        let page = std::fs::read_to_string(folder.join(name)).unwrap();
        assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"), "{name}");
        for outside in ["src=", "@import", "url(", "<link", "<script", "href=\"http", "NaN"] {
            assert!(!page.contains(outside), "{name}: {outside}");
        }
        assert!(page.contains("Where this comes from") && page.contains("@media print"), "{name}");
        if let Some(kept) = std::env::var_os("CYLWATCH_LOOK") {
            std::fs::copy(folder.join(name), Path::new(&kept).join(name)).unwrap();
        }
    }
    let Some(browser) = browser() else {
        eprintln!("skipped: no Chromium or Chrome is installed to look at the reports");
        return;
    };
    let mut covered = Vec::new();
    for name in names {
        for width in [1200, 390] {
            let seen = seen(&browser, &folder.join(name), width);
            let at = format!("{name} at {width}: {seen:?}");
            assert!(!seen.title.is_empty() && seen.headings >= 2 && seen.rows >= 4, "{at}");
            assert_eq!(seen.loaded, 0, "{at}");
            assert!(seen.wide <= seen.window, "{at}");
            assert_eq!(
                seen.pictures.is_empty(),
                ["properties.html", "inspect.html", "inspection.html"].contains(&name),
                "{at}"
            );
            assert!(seen.pictures.iter().all(|height| *height > 100.0) && seen.unnamed == 0, "{at}");
            if !seen.covered.is_empty() {
                covered.push(at);
            }
        }
    }
    assert!(covered.is_empty(), "{covered:#?}");
}

#[test]
fn the_page_of_a_fleet_fits_a_desk_and_a_phone_and_runs_no_name_as_a_script() {
    let folder = tempdir().unwrap();
    let folder = folder.path().canonicalize().unwrap();
    std::fs::create_dir(folder.join("logs")).unwrap();
    let rows: Vec<String> =
        (0..200).map(|minute| format!("{},15.0,{}\n", 60 * minute, 200 - minute % 2)).collect();
    let text = format!("time_s,shoulder_degc,pressure_bar\n{}", rows.concat());
    let long = "a cylinder with a name that is longer than a phone is wide ".repeat(3);
    for name in ["A-1", "<img src=x onerror=document.title='ran'>", "<script>document.title='ran'", &long] {
        std::fs::write(folder.join("logs").join(format!("{name}.csv")), &text).unwrap();
    }
    std::fs::write(folder.join("logs/empty.csv"), "").unwrap();
    let options = ["fleet", "logs", "--vessel", "nitrogen-20l", "-o", "fleet", "-q"];
    assert_eq!(run(&folder, &options).code, Some(3));
    if let Some(kept) = std::env::var_os("CYLWATCH_LOOK") {
        std::fs::copy(folder.join("fleet/page.html"), Path::new(&kept).join("fleet.html")).unwrap();
    }
    let Some(browser) = browser() else {
        eprintln!("skipped: no Chromium or Chrome is installed to look at the page");
        return;
    };
    for width in [1280, 390] {
        let seen = seen(&browser, &folder.join("fleet/page.html"), width);
        assert_eq!((seen.title.as_str(), seen.loaded), ("Fleet of 5 cylinders", 0), "{seen:?}");
        // Five rows that the script draws, with the heads, what could not be read, and what the words mean.
        assert!(seen.rows >= 12 && seen.wide <= seen.window, "{width}: {seen:?}");
    }
}
