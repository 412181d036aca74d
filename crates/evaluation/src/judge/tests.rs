//! What a sceptic asks of a judge: known candidates get the scores that they deserve.
use std::time::{Duration, Instant};

use super::fixture::{Toys, all, group, group_of, judged, plan, settings};
use super::measures::Reached;
use super::run::run;
use super::score::coverage::Quantity;
use super::table::TABLE;

const RAILWAY: &str = "nitrogen-20l/railway/mixed/class-b/120s";
const TIGHT: &str = "{ kind = \"nothing\" }";
const LEAKS: &str = "{ kind = \"leak\", part_per_h = [1e-5, 1e-4, 1e-3, 1e-2], onset_h = [30.0, 40.0] }";
const FAST: &str =
    "{ kind = \"fast-loss\", part = [0.1, 0.5], within_min = 30.0, onset_h = [1.0, 40.0], goes_on = false }";

fn share(shares: &Option<std::collections::BTreeMap<String, f64>>, class: &str) -> f64 {
    shares.as_ref().unwrap()[class]
}

#[test]
fn a_perfect_candidate_scores_perfect() {
    let groups = group(RAILWAY, (1, 4), 12.0, &format!("{TIGHT}, {LEAKS}, {FAST}"));
    let table = judged(&plan(&["perfect"], &groups));
    let of = all(&table, 0);
    assert_eq!((of.worlds, of.failed, of.simulations), (4 * 7, 0, 4));
    for shares in &of.tight.shares {
        assert_eq!(share(shares, "tight"), 1.0);
    }
    for rate in [of.tight.losses, of.tight.leaks, of.tight.exchanges, of.tight.sensor_faults] {
        let rate = rate.unwrap();
        assert_eq!((rate.count, rate.simulations, rate.per_ten_years), (0, 4, 0.0));
        assert!((rate.cylinder_years - 48.0 / 365.25).abs() < 1e-3);
    }
    assert_eq!(of.tight.unknown_later.unwrap().share, 0.0);
    let leaks = of.leaks.as_ref().unwrap();
    for horizon in ["1 h", "24 h", "7 d"] {
        let smallest = leaks.smallest_percent_h[horizon].unwrap();
        assert_eq!(smallest.rate, Reached::AtMost(1e-3), "{horizon}");
    }
    // 200 bar: 1 % are 2 bar.
    assert!((leaks.bar_per_percent - 2.0).abs() < 1e-9);
    let stated: Vec<_> = of.coverage.iter().filter_map(|row| row.held).collect();
    assert!(stated.len() >= 10 && stated.iter().all(|held| held.share == 1.0));
    assert!(of.coverage.iter().all(|row| row.rms == Some(0.0)));
    assert_eq!((of.fast[0].in_time.unwrap().share, of.fast[0].told.unwrap().trials), (1.0, 8.0));
    assert_eq!(of.disagreements.as_ref().unwrap().disagreeing, 0);
}

#[test]
fn who_always_says_the_same_is_found_out() {
    let groups = group(RAILWAY, (1, 4), 4.0, &format!("{TIGHT}, {LEAKS}, {FAST}"));
    let table = judged(&plan(&["leaks", "unknowns", "tights"], &groups));
    let [leaks, unknowns, tights] = [0, 1, 2].map(|candidate| all(&table, candidate));
    let false_leaks = leaks.tight.leaks.unwrap();
    assert_eq!((false_leaks.count, false_leaks.simulations_with), (4, 4));
    assert_eq!((leaks.tight.leaks_in_first_day, share(&leaks.tight.shares[1], "leak")), (4, 1.0));
    // A leak that was said before its onset is not found, a fast loss not told.
    let rows = &leaks.leaks.as_ref().unwrap().by_rate;
    assert!(rows.iter().all(|row| (row.delay.leaks, row.delay.found) == (0, 0)));
    assert_eq!((leaks.fast[0].before, leaks.fast[0].told), (8, None));

    assert_eq!(unknowns.tight.unknown_later.unwrap().share, 1.0);
    assert_eq!((unknowns.tight.leaks.unwrap().count, unknowns.fast[0].told.unwrap().share), (0, 0.0));
    assert_eq!(share(&tights.tight.shares[0], "tight"), 1.0);
    assert_eq!((tights.tight.leaks.unwrap().count, tights.fast[0].in_time.unwrap().share), (0, 0.0));
    for of in [unknowns, tights] {
        let smallest = of.leaks.as_ref().unwrap().smallest_percent_h["24 h"].unwrap();
        assert_eq!(smallest.rate, Reached::Above(1.0));
    }
    assert_eq!(share(&tights.lost_shares[1], "tight"), 1.0);
}

#[test]
fn intervals_of_known_normal_errors_hold_the_truth_in_95_percent_and_innovations_are_white_with_nis_1() {
    let groups = group(RAILWAY, (1, 6), 30.0, &format!("{TIGHT}, {LEAKS}"));
    let table = judged(&plan(&["honest"], &groups));
    let of = all(&table, 0);
    let quantities = [Quantity::Mass, Quantity::Gas, Quantity::Leak];
    for quantity in quantities {
        for (gas, period) in [("tight", "first day"), ("tight", "later"), ("lost", "later")] {
            let row =
                of.coverage.iter().find(|row| (row.quantity, row.gas, row.period) == (quantity, gas, period));
            let held = row.unwrap().held.unwrap();
            // Rows of these candidates are independent: four standard deviations of the binomial.
            let bound = 4.0 * (0.95 * 0.05 / held.trials).sqrt();
            assert!((held.share - 0.95).abs() < bound, "{quantity:?} {gas} {period}: {}", held.share);
        }
    }
    assert_eq!(of.innovations.len(), 5);
    for row in &of.innovations {
        let bound = 4.0 / (row.count as f64).sqrt();
        assert!((row.nis.unwrap() - 1.0).abs() < 1.5 * bound, "{row:?}");
        // Rows of 2 min: no pairs a minute apart.
        assert_eq!(row.autocorrelation[0], None);
        assert!(row.autocorrelation[1].unwrap().abs() < bound, "{row:?}");
    }
    let (sd, correlation_time_s) = of.free_mass_noise.unwrap();
    assert!((sd / 0.005 - 1.0).abs() < 0.05 && correlation_time_s < 600.0, "{sd} {correlation_time_s}");
}

#[test]
fn the_smallest_leak_of_a_known_law_of_detection_is_found() {
    // A thousandth of the gas must be lost: 1e-3 per hour within an hour, 1/24 of it within a day, 1/168 within a week.
    let rates: Vec<String> = (0..26).map(|n| format!("{:.6e}", 2e-6 * 1.35_f64.powi(n))).collect();
    let rates = rates.join(", ");
    let leaks = format!("{TIGHT}, {{ kind = \"leak\", part_per_h = [{rates}], onset_h = [30.0, 40.0] }}");
    let table = judged(&plan(&["lawful", "honest"], &group(RAILWAY, (1, 8), 9.0, &leaks)));
    let leaks = all(&table, 0).leaks.as_ref().unwrap();
    for (horizon, hours) in [("1 h", 1.0), ("24 h", 24.0), ("7 d", 168.0)] {
        let Reached::At(found) = leaks.smallest_percent_h[horizon].unwrap().rate else { panic!("{horizon}") };
        let truth = 0.1 / hours;
        assert!(found > truth / 1.35 && found < truth * 1.35, "{horizon}: {found} for {truth}");
    }
    let delays: Vec<f64> = leaks.by_rate.iter().filter_map(|row| row.delay.median_s).collect();
    assert!(delays.len() > 20 && delays.windows(2).all(|pair| pair[1] < pair[0]));
    // The noise of the candidate that has a mass bounds the delay of the other one.
    let bounds: Vec<f64> = leaks.by_rate.iter().filter_map(|row| row.bound_s).collect();
    assert!(bounds.len() == 26 && bounds.windows(2).all(|pair| 0.0 < pair[1] && pair[1] < pair[0]));
}

#[test]
fn contradictions_that_were_planted_are_counted_and_no_others() {
    let table = judged(&plan(&["contradictory", "perfect"], &group(RAILWAY, (1, 2), 1.0, TIGHT)));
    let found = all(&table, 0).disagreements.as_ref().unwrap();
    assert_eq!((found.rows, found.disagreeing), (2 * 721, 2 * 73));
    assert_eq!(found.by_rule.values().copied().collect::<Vec<_>>(), [2 * 73]);
    assert_eq!(all(&table, 1).disagreements.as_ref().unwrap().disagreeing, 0);
    // Both worlds are named with what makes them again.
    let named = &table.candidates[0].contradictions;
    assert!(named.len() == 2 && named[0].contains(&format!("{RAILWAY} seed 1 set 0")), "{named:?}");
    assert!(table.candidates[1].contradictions.is_empty());
}

#[test]
fn a_statistic_gets_its_threshold_from_the_families_that_tune_alone() {
    let tuning = group("nitrogen-20l/workshop/mixed/class-b/120s", (1, 40), 5.0, TIGHT);
    let judging = group(RAILWAY, (1, 4), 5.0, &format!("{TIGHT}, {LEAKS}"));
    let table = judged(&plan(&["lost-mass"], &format!("{tuning}{judging}")));
    let tuned = table.candidates[0].threshold.unwrap();
    assert_eq!(tuned.worlds, 40);
    // 3600 rows of a sd of 1e-5 each: the largest of a world is near 3.6 sd, once in ten years near 5.2 sd.
    assert!((4e-5..7e-5).contains(&tuned.level.threshold), "{tuned:?}");
    let of = all(&table, 0);
    assert_eq!((of.tight.worlds, of.tight.leaks.unwrap().count), (4, 0));
    let found = &of.leaks.as_ref().unwrap().by_rate;
    assert!(found.iter().all(|row| row.delay.found == 4), "{found:?}");
    // Other worlds that judge leave the threshold as it is.
    let other = group("nitrogen-20l/desert/mixed/class-b/120s", (1, 4), 5.0, &format!("{TIGHT}, {LEAKS}"));
    let again = judged(&plan(&["lost-mass"], &format!("{tuning}{other}")));
    assert_eq!(again.candidates[0].threshold.unwrap().level, tuned.level);
}

#[test]
fn a_statistic_with_too_few_worlds_to_tune_on_has_no_threshold_and_that_is_named() {
    let tuning = group("nitrogen-20l/workshop/mixed/class-b/120s", (1, 4), 5.0, TIGHT);
    let groups = format!("{tuning}{}", group(RAILWAY, (1, 2), 5.0, &format!("{TIGHT}, {LEAKS}")));
    let folder = tempfile::tempdir().unwrap();
    let table =
        run(&plan(&["lost-mass", "lawful"], &groups), &Toys, &settings(folder.path(), 2), &|_| ()).unwrap();
    let [silent, lawful] = &table.candidates[..] else { panic!("two candidates") };
    assert!(silent.threshold.is_none() && silent.failures[0].starts_with("no threshold"), "{silent:?}");
    assert!(lawful.failures.is_empty() && !table.is_whole());
    assert!(table.to_markdown().contains("no threshold"));
}

#[test]
fn groups_hold_the_worlds_of_their_axis() {
    let families = "nitrogen-20l|argon-50l/railway|desert/mixed/class-a|class-b/120s";
    let table = judged(&plan(&["perfect"], &group(families, (1, 2), 3.0, TIGHT)));
    assert_eq!((all(&table, 0).worlds, all(&table, 0).simulations), (16, 8));
    for name in ["vessel argon-50l", "climate desert", "sensors class-a"] {
        let of = group_of(&table, 0, name);
        assert_eq!(
            (of.worlds, of.simulations),
            (8, if name.starts_with("sensors") { 8 } else { 4 }),
            "{name}"
        );
    }
    assert_eq!(group_of(&table, 0, "argon-50l/desert").worlds, 4);
    assert_eq!(group_of(&table, 0, "logs of 2 to 30 d").worlds, 16);
    assert_eq!(group_of(&table, 0, "argon-50l/desert/mixed/class-a/120s").worlds, 2);
}

fn tables(folder: &std::path::Path) -> Vec<Vec<u8>> {
    TABLE.iter().map(|name| std::fs::read(folder.join(name)).unwrap()).collect()
}

fn many() -> super::plan::Plan {
    let tuning = group("nitrogen-20l/workshop/mixed/class-b/120s", (1, 10), 2.0, TIGHT);
    let families = "nitrogen-20l|argon-50l/railway|desert/mixed/class-a|class-b/120s";
    let judging = group(families, (1, 4), 3.0, &format!("{TIGHT}, {LEAKS}, {FAST}"));
    plan(&["honest", "lawful", "contradictory", "lost-mass"], &format!("{tuning}{judging}"))
}

#[test]
fn threads_and_the_order_of_finishing_do_not_change_a_byte_of_the_table() {
    let plan = many();
    let folders: Vec<_> = [1, 2, 7]
        .into_iter()
        .map(|threads| {
            let folder = tempfile::tempdir().unwrap();
            run(&plan, &Toys, &settings(folder.path(), threads), &|_| ()).unwrap();
            folder
        })
        .collect();
    let first = tables(folders[0].path());
    assert!(folders.iter().all(|folder| tables(folder.path()) == first));
}

#[test]
fn stopped_after_some_worlds_the_table_is_partial_and_the_rest_follows() {
    let plan = many();
    let (whole, parts) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run(&plan, &Toys, &settings(whole.path(), 2), &|_| ()).unwrap();
    let mut some = settings(parts.path(), 2);
    some.most_worlds = Some(30);
    let partial = run(&plan, &Toys, &some, &|_| ()).unwrap();
    assert_eq!((partial.provenance.finished, partial.provenance.worlds), (30, plan.tasks.len()));
    assert!(!partial.is_whole());
    assert!(String::from_utf8(tables(parts.path())[0].clone()).unwrap().contains("(partial)"));
    run(&plan, &Toys, &settings(parts.path(), 2), &|_| ()).unwrap();
    assert_eq!(tables(parts.path()), tables(whole.path()));
}

/// Folder that the child of the next test writes into.
const CHILD_FOLDER: &str = "CYLWATCH_JUDGE_CHILD_FOLDER";

#[test]
#[ignore = "a part of the next test: runs in a process that is killed"]
fn child_that_is_killed() {
    let Ok(folder) = std::env::var(CHILD_FOLDER) else { return };
    // Partial tables, too, may be cut off.
    let slowly = |_| std::thread::sleep(Duration::from_millis(2));
    run(&many(), &Toys, &settings(folder.as_ref(), 2), &slowly).unwrap();
}

#[test]
fn killed_at_20_random_moments_and_resumed_the_table_is_the_same_byte_for_byte() {
    let plan = many();
    let (whole, killed) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run(&plan, &Toys, &settings(whole.path(), 2), &|_| ()).unwrap();
    let child = || {
        std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--ignored", "--exact", "judge::tests::child_that_is_killed"])
            .env(CHILD_FOLDER, killed.path())
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap()
    };
    let journal = killed.path().join(super::journal::JOURNAL);
    let length = || std::fs::metadata(&journal).map_or(0, |of| of.len());
    let (mut kills, mut state) = (0, 0x2545_f491_4f6c_dd1d_u64);
    while kills < 20 {
        let before = length();
        let mut child = child();
        // Kill at a random moment after it has begun to write, whatever a start takes on this machine.
        let begin = Instant::now();
        while length() == before && begin.elapsed() < Duration::from_secs(60) {
            if child.try_wait().unwrap().is_some() {
                break;
            }
            std::thread::sleep(Duration::from_micros(200));
        }
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        std::thread::sleep(Duration::from_micros((state >> 33) % 20_000));
        let running = child.try_wait().unwrap().is_none();
        child.kill().unwrap();
        child.wait().unwrap();
        if !running {
            break;
        }
        kills += 1;
    }
    assert_eq!(kills, 20, "the run ended after {kills} kills: give it more worlds");
    run(&plan, &Toys, &settings(killed.path(), 2), &|_| ()).unwrap();
    assert_eq!(tables(killed.path()), tables(whole.path()));
}
