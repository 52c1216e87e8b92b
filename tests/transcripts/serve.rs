//! `serve` as another program uses it: one line, one answer, and nothing that ends it but `quit` and the end of its input.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

struct Server {
    child: Child,
    requests: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
}

impl Server {
    fn start(scenario: &str) -> Server {
        let mut child = Command::new(env!("CARGO_BIN_EXE_stickslip"))
            .args(["serve", scenario])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let requests = child.stdin.take();
        let answers = BufReader::new(child.stdout.take().expect("a pipe"));
        Server { child, requests, answers }
    }

    fn send(&mut self, line: &[u8]) {
        let requests = self.requests.as_mut().expect("open");
        requests.write_all(line).and_then(|()| requests.write_all(b"\n")).expect("it reads");
    }

    fn answer(&mut self) -> Value {
        let mut line = String::new();
        self.answers.read_line(&mut line).expect("it writes");
        serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: {line:?}"))
    }

    fn ask(&mut self, command: &str) -> Value {
        self.send(json!({"id": command, "command": command}).to_string().as_bytes());
        let answer = self.answer();
        assert_eq!(answer["id"], command);
        answer
    }

    /// The report of a command that succeeds.
    fn report(&mut self, command: &str) -> Value {
        let mut answer = self.ask(command);
        assert_eq!(answer["ok"], true, "{answer}");
        answer["report"].take()
    }

    fn status(mut self) -> Option<i32> {
        self.requests = None;
        self.child.wait().expect("it ends").code()
    }
}

#[test]
fn a_request_is_answered_by_the_report_of_replay() {
    let commands = ["set f 0.4", "pairs", "status", "show x_n c1, p", "ray"];
    let script = commands.join("\n");
    let mut replay = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .args(["replay", "-", "--format", "json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    replay.stdin.take().expect("a pipe").write_all(script.as_bytes()).expect("it reads");
    let replayed = replay.wait_with_output().expect("it ends").stdout;
    let mut server = Server::start("beam");
    for (command, line) in commands.into_iter().zip(String::from_utf8(replayed).expect("text").lines()) {
        let line: Value = serde_json::from_str(line).expect("JSON");
        assert_eq!(server.report(command), line["report"], "{command}");
    }
    // several commands in one request: their reports in a list
    let both = server.report("reset; pairs c1\nshow x_n c1");
    assert_eq!(both.as_array().map(Vec::len), Some(3));
    assert_eq!(both[1][0]["id"], "c1");
    assert_eq!(server.report("   # only a remark"), Value::Null);
    assert_eq!(server.status(), Some(0));
}

#[test]
fn what_is_no_request_is_answered_too() {
    let mut server = Server::start("beam");
    let long = format!("{{\"id\": 1, \"command\": \"echo {}\"}}", "x".repeat(1 << 20));
    let deep = "[".repeat(100_000);
    for (line, id, message) in [
        ("nonsense".as_bytes(), Value::Null, "not JSON"),
        (b"", Value::Null, "not JSON"),
        (b"\xff\xfe{}", Value::Null, "not JSON"),
        (b"{\"id\": 1, \"command\": \"pairs\"} {}", Value::Null, "not JSON"),
        (deep.as_bytes(), Value::Null, "not JSON"),
        (b"[\"pairs\"]", Value::Null, "no object"),
        (long.as_bytes(), Value::Null, "1048576 bytes"),
        (b"{\"id\": 7}", json!(7), "`command` is missing"),
        (b"{\"id\": \"a\", \"command\": [\"pairs\"]}", json!("a"), "must be a string"),
        (b"{\"id\": null, \"comand\": \"pairs\"}", Value::Null, "did you mean `command`"),
        (b"{\"id\": 8, \"command\": \"pairs\", \"timeout\": 3}", json!(8), "unknown key `timeout`"),
        (b"{\"id\": 9, \"command\": \"piars\"}", json!(9), "did you mean `pairs`"),
        (b"{\"id\": 1, \"command\": \"pairs\", \"id\": 2}", Value::Null, "`id` stands there twice"),
        (b"{\"command\": \"pairs\", \"id\": 3, \"command\": \"ray\"}", json!(3), "`command` stands there twice"),
        (b"{\"id\": 4, \"command\": \"\\ud800\"}", json!(4), "`command` is no string"),
        (b"{\"id\": 10, \"command\": \"tui\"}", json!(10), "full screen"),
        (b"{\"id\": 11, \"command\": \"pairs c99; quit\"}", json!(11), "c99"),
    ] {
        server.send(line);
        let answer = server.answer();
        assert_eq!((&answer["id"], &answer["ok"], &answer["status"]), (&id, &json!(false), &json!(2)), "{answer}");
        let error = answer["error"].as_str().expect("a sentence");
        assert!(error.contains(message), "{error}");
        assert!(answer.get("report").is_none());
    }
    // nothing of it changed the session
    assert_eq!(server.report("status")["outcome"], "normal");
    assert_eq!(server.ask("expect p = 5")["status"], 1);
    assert_eq!(server.report("pairs c99; expect error c99").as_array().map(Vec::len), Some(2));
    assert_eq!(server.report("quit"), Value::Null);
    assert_eq!(server.child.wait().expect("it ends").code(), Some(0));
}

/// Whatever the digits and the size of a number, and the keys of an object: not a digit is another one.
#[test]
fn an_id_comes_back_as_it_was_written() {
    let mut server = Server::start("beam");
    for id in ["18446744073709551617", "-123456789012345678901234567890", "1.50", "1e400", "[1, {\"a\": 2}]", "\"ü\""]
    {
        server.send(format!("{{\"id\": {id}, \"command\": \"status\"}}").as_bytes());
        let mut line = String::new();
        server.answers.read_line(&mut line).expect("it writes");
        assert!(line.starts_with(&format!("{{\"id\":{id},\"ok\":true,")), "{line}");
    }
}

#[test]
fn a_scenario_that_does_not_load_is_told_problem_by_problem() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("bad.json");
    let text = "{\n  \"format\": \"stickslip/1\",\n  \"title\": \"t\",\n  \"lcp\": { \"M\": [[1]], \"q\": [1, 2], \"d\": 3 }\n}\n";
    std::fs::write(&file, text).expect("a file");
    let mut server = Server::start("beam");
    let answer = server.ask(&format!("load '{}'", file.display()));
    assert_eq!(answer["ok"], false);
    let problems = answer["problems"].as_array().expect("a list");
    assert!(problems.iter().any(|problem| problem["line"] == 4 && problem["path"] == "lcp.d"), "{answer}");
    // as on any pipe: what follows was meant for the scenario that is not there
    assert_eq!(server.ask("pairs")["ok"], false);
    assert_eq!(server.report("load beam")["outcome"], "normal");
    assert_eq!(server.status(), Some(0));
}

#[cfg(unix)]
#[test]
fn sigint_stops_the_command_and_leaves_the_session() {
    let folder = tempfile::tempdir().expect("a folder");
    let rows = folder.path().join("rows.csv");
    let mut server = Server::start("beam");
    server.report("set f 0.6");
    let interrupt = |server: &Server| {
        let pid = server.child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &pid]).status().expect("kill").success());
    };
    let command = format!("sweep F2 0..400 1000000 --out '{}'", rows.display());
    server.send(json!({"id": 1, "command": command}).to_string().as_bytes());
    let start = Instant::now();
    while !std::fs::metadata(&rows).is_ok_and(|rows| rows.len() > 0) {
        assert!(start.elapsed() < Duration::from_secs(60), "the sweep does not begin");
        std::thread::sleep(Duration::from_millis(10));
    }
    interrupt(&server);
    let answer = server.answer();
    assert!(answer.to_string().contains("stopped"), "{answer}");
    interrupt(&server);
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(server.report("status")["parameters"]["f"], 0.6);
    assert_eq!(server.status(), Some(0));
}
