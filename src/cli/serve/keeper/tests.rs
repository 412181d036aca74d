//! Kills at moments that a process can hardly be caught at.
use super::*;
use crate::cli::serve::config;
use tempfile::{TempDir, tempdir};

const LAST: u32 = 300;

/// A cylinder that leaks 6 bar/h from minute 200 on.
fn row(minute: u32) -> Delivered {
    let residue = |by: u32| f64::from(minute * minute * by % 101) / 50.0 - 1.0;
    let pressure = 200.0 + 0.02 * residue(11) - f64::from(minute.saturating_sub(200)) / 10.0;
    let cells = vec![15.0 + 0.03 * residue(3), 15.0 + 0.03 * residue(7), pressure];
    Delivered::Row(Accepted { time_ns: (1_767_225_600 + 60 * i64::from(minute)) * 1_000_000_000, cells })
}

fn settings() -> (TempDir, Arc<Settings>) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("gateway.toml");
    let text = r#"
[broker]
host = "localhost"
client_id = "a"
[store]
folder = "store"
[[type]]
name = "t"
vessel = "nitrogen-20l"
options = { fill_pressure_bar = 200, fill_temperature_degc = 15, settled = true }
[[cylinder]]
name = "B"
type = "t"
topic = "b"
[payload]
clock = "arrival"
reading = [{ name = "shoulder_degc", at = "/s" }, { name = "valve_degc", at = "/v" }, { name = "pressure_bar", at = "/p" }]
"#;
    std::fs::write(&path, text).unwrap();
    let (settings, _) = config::read(&path).unwrap();
    (folder, Arc::new(settings))
}

fn opened(settings: &Arc<Settings>) -> Keeper<'static> {
    let messages: &'static Messages = Box::leak(Box::new(Messages::kept()));
    Keeper::open(Arc::clone(settings), messages).unwrap()
}

fn take(keeper: &mut Keeper<'_>, minutes: std::ops::Range<u32>) {
    for minute in minutes {
        keeper.record(&[("B".to_owned(), row(minute))]).unwrap();
        assert!(keeper.take("B", row(minute)).is_ok());
    }
}

/// What a broker gets that takes everything: events and changes of alarms.
fn deliver(keeper: &mut Keeper<'_>) -> Vec<String> {
    let mut events = Vec::new();
    while let Some(message) = keeper.outbox.hand(1) {
        keeper.outbox.sent(1);
        keeper.outbox.arrived(1);
        events.extend(message.event_of.map(|_| message.payload));
    }
    events
}

/// Saves the state, if its events have arrived, and waits for it.
fn save(keeper: &mut Keeper<'_>) -> bool {
    keeper.save(&["B".to_owned()]).unwrap();
    keeper.settle().unwrap();
    keeper.unsaved().is_empty()
}

fn state(settings: &Settings) -> Option<Vec<u8>> {
    std::fs::read(settings.folder.join("states/B.state")).ok()
}

/// Events and state of a run that nothing disturbs.
fn undisturbed() -> (Vec<String>, Vec<u8>) {
    let (_folder, settings) = settings();
    let mut keeper = opened(&settings);
    take(&mut keeper, 0..LAST);
    let events = deliver(&mut keeper);
    assert!(events.len() >= 3 && save(&mut keeper), "{events:?}");
    (events, state(&settings).unwrap())
}

#[test]
fn a_state_waits_until_its_events_have_arrived_so_that_a_kill_loses_none() {
    let (_folder, settings) = settings();
    let mut keeper = opened(&settings);
    take(&mut keeper, 0..LAST);
    assert!(!save(&mut keeper) && state(&settings).is_none());
    // Killed before anything was sent.
    drop(keeper);
    let mut keeper = opened(&settings);
    assert_eq!(deliver(&mut keeper), undisturbed().0);
    assert!(save(&mut keeper));
    assert!(keeper.unsaved().is_empty());
}

#[test]
fn whatever_step_of_a_save_a_kill_comes_after_the_state_is_that_of_a_run_without_it() {
    let (expected_events, expected) = undisturbed();
    for step in 0..5 {
        let (_folder, settings) = settings();
        let mut keeper = opened(&settings);
        take(&mut keeper, 0..120);
        let mut events = deliver(&mut keeper);
        assert!(save(&mut keeper));
        let first = state(&settings).unwrap();
        take(&mut keeper, 120..230);
        events.extend(deliver(&mut keeper));
        keeper.turn_over().unwrap();
        take(&mut keeper, 230..260);
        events.extend(deliver(&mut keeper));
        match step {
            // Before the save.
            0 => {}
            // The hash is in the journal, and the state is not written.
            1 => {
                assert!(save(&mut keeper));
                std::fs::write(settings.folder.join("states/B.state"), &first).unwrap();
            }
            // The state is written.
            2 => assert!(save(&mut keeper)),
            // The old segments are gone.
            3 => {
                assert!(save(&mut keeper));
                keeper.turn_over().unwrap();
                keeper.turn_over().unwrap();
            }
            // A row is in the journal, and the monitor has not seen it.
            _ => keeper.record(&[("B".to_owned(), row(260))]).unwrap(),
        }
        drop(keeper);
        let mut keeper = opened(&settings);
        take(&mut keeper, if step == 4 { 261..LAST } else { 260..LAST });
        events.extend(deliver(&mut keeper));
        assert!(save(&mut keeper));
        assert!(state(&settings).unwrap() == expected, "step {step}");
        events.sort();
        events.dedup();
        let mut wanted = expected_events.clone();
        wanted.sort();
        assert_eq!(events, wanted, "step {step}");
    }
}

#[test]
fn a_monitor_that_began_anew_begins_there_again_after_a_kill_before_and_after_the_old_state_is_set_aside() {
    for is_back in [false, true] {
        let (_folder, settings) = settings();
        let mut keeper = opened(&settings);
        take(&mut keeper, 0..100);
        deliver(&mut keeper);
        assert!(save(&mut keeper));
        let before = state(&settings).unwrap();
        keeper.begin_anew("B", "a reason").unwrap();
        assert!(state(&settings).is_none());
        if is_back {
            std::fs::write(settings.folder.join("states/B.state"), before).unwrap();
        }
        take(&mut keeper, 100..200);
        drop(keeper);
        let mut keeper = opened(&settings);
        let events = deliver(&mut keeper);
        assert!(events.len() == 2 && events[0].contains("cold-start"), "{events:?}");
        assert!(events[1].contains("alarm-state-lost-active-1767231540000"), "{events:?}");
        assert!(save(&mut keeper));
        let (_other, fresh) = self::settings();
        let mut alone = opened(&fresh);
        take(&mut alone, 100..200);
        deliver(&mut alone);
        assert!(save(&mut alone));
        assert!(state(&settings) == state(&fresh));
    }
}

#[test]
fn rows_of_a_monitor_that_has_failed_are_refused_now_and_when_the_journal_is_read_again() {
    let (_folder, settings) = settings();
    let mut keeper = opened(&settings);
    take(&mut keeper, 0..100);
    keeper.cylinders.get_mut("B").unwrap().failed = Some("a reason".to_owned());
    keeper.failed.insert("B".to_owned());
    keeper.record(&[("B".to_owned(), row(100))]).unwrap();
    assert_eq!(keeper.take("B", row(100)).unwrap_err().0, Refusal::Monitor);
    keeper.begin_failed_anew().unwrap();
    take(&mut keeper, 101..200);
    deliver(&mut keeper);
    let expected = keeper.cylinders["B"].steps.state_file().unwrap();
    drop(keeper);
    let keeper = opened(&settings);
    assert!(keeper.cylinders["B"].steps.state_file().unwrap() == expected);
}

/// The configuration with something replaced.
fn with(folder: &TempDir, from: &str, to: &str) -> Arc<Settings> {
    let path = folder.path().join("gateway.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains(from));
    std::fs::write(&path, text.replace(from, to)).unwrap();
    Arc::new(config::read(&path).unwrap().0)
}

#[test]
fn another_configuration_goes_on_with_the_monitors_of_before_or_leaves_all_as_it_was() {
    let (folder, settings) = settings();
    let mut keeper = opened(&settings);
    take(&mut keeper, 0..200);
    deliver(&mut keeper);
    // Another vessel's monitor cannot go on from this state.
    let before = keeper.cylinders["B"].steps.state_file().unwrap();
    let error = keeper.take_over(with(&folder, "nitrogen-20l\"", "nitrogen-20l-paper\"")).unwrap_err();
    assert!(format!("{error:#}").contains("B cannot go on"), "{error:#}");
    assert!(keeper.cylinders["B"].steps.state_file().unwrap() == before);
    with(&folder, "nitrogen-20l-paper\"", "nitrogen-20l\"");
    let more = "[[cylinder]]\nname = \"B\"\ntype = \"t\"\ntopic = \"b\"\noptions = { limit_bar = 150 }\n\
                [[cylinder]]\nname = \"C\"\ntype = \"t\"\ntopic = \"c\"\n";
    let settings = with(&folder, "[[cylinder]]\nname = \"B\"\ntype = \"t\"\ntopic = \"b\"\n", more);
    let changes = keeper.take_over(Arc::clone(&settings)).unwrap();
    assert_eq!(changes, "1 cylinders new, 1 with other options or readings, 0 left");
    take(&mut keeper, 200..LAST);
    deliver(&mut keeper);
    // As a monitor that was stopped and went on with the other limit.
    let (other, fresh) = self::settings();
    let mut alone = opened(&fresh);
    take(&mut alone, 0..200);
    deliver(&mut alone);
    assert!(save(&mut alone));
    drop(alone);
    let mut alone = opened(&with(&other, "settled = true", "settled = true, limit_bar = 150"));
    take(&mut alone, 200..LAST);
    assert!(
        keeper.cylinders["B"].steps.state_file().unwrap() == alone.cylinders["B"].steps.state_file().unwrap()
    );
    // What leaves is saved, and the broker forgets it.
    let settings = with(&folder, &more[..more.rfind("[[cyl").unwrap()], "");
    assert!(keeper.take_over(settings).unwrap().ends_with("1 left"));
    let cleared: Vec<_> = std::iter::from_fn(|| {
        let message = keeper.outbox.hand(usize::MAX)?;
        Some((message.topic, message.payload))
    })
    .filter(|(_, payload)| payload.is_empty())
    .collect();
    assert!(cleared.contains(&("cylwatch/B/alarm/leak".to_owned(), String::new())), "{cleared:?}");
    assert!(state_of(&folder, "B").is_some() && keeper.len() == 1);
}

fn state_of(folder: &TempDir, name: &str) -> Option<Vec<u8>> {
    std::fs::read(folder.path().join(format!("store/states/{name}.state"))).ok()
}
