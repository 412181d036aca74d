//! The depot of the tutorial.
use super::broker::free_port;
use super::*;

#[test]
fn the_depot_of_the_tutorial_is_made_and_played_and_its_leak_is_found() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let Some(broker) = Broker::begin(folder) else { return };
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("book/gateway");
    let path = Path::new(env!("CARGO_BIN_EXE_cylwatch")).parent().unwrap();
    std::fs::copy(source.join("make.sh"), folder.join("make.sh")).unwrap();
    let paths = format!("{}:{}", path.display(), std::env::var("PATH").unwrap());
    let made = Command::new("bash").args(["make.sh", "10"]).current_dir(folder).env("PATH", paths).output();
    assert!(made.as_ref().unwrap().status.success(), "{made:?}");
    // The leak and a tight one.
    for number in [1, 2, 3, 4, 5, 6, 7, 8] {
        std::fs::remove_file(folder.join(format!("logs/N0{number}.csv"))).unwrap();
    }
    let text = std::fs::read_to_string(source.join("gateway.toml")).unwrap();
    let text = text.replace("[broker]", &format!("[broker]\nport = {}", broker.port));
    let text = text.replace("127.0.0.1:8742", &format!("127.0.0.1:{}", free_port()));
    std::fs::write(folder.join("gateway.toml"), text).unwrap();
    let heard = listen(broker.port, "listener");
    let played = run(folder, &["serve", "gateway.toml", "--replay", "logs", "--speed", "max"]);
    assert_eq!(played.code, Some(0), "{}", played.stderr);
    assert!(played.stderr.contains("20162 rows of 2 cylinders"), "{}", played.stderr);
    schema::assert_true_of(&heard);
    let verdict = |name: &str| {
        let topic = format!("cylwatch/{name}/verdict");
        let last = heard.lock().unwrap().iter().rfind(|(of, _, _)| *of == topic).unwrap().1.clone();
        serde_json::from_str::<serde_json::Value>(&last).unwrap()["verdict"].clone()
    };
    assert_eq!((verdict("N09"), verdict("N10")), ("tight".into(), "leak".into()));
}
