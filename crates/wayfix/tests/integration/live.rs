//! `wayfix run … --live`: what is refused. What is served, a client that is not ours sees (`xtask/clients/watch_live.py`).

use crate::common::{Scratch, run_slam, walk};

#[cfg(feature = "live")]
#[test]
fn used_port_and_invalid_address_are_refused_with_a_remedy() {
    let scratch = Scratch::new();
    let log = scratch.file("walk.txt", walk(5));
    let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address").to_string();
    let outcome = run_slam(&log, &["--live", &address]);
    assert_eq!(outcome.code, 1, "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("is in use") && outcome.stderr.contains("another port"),
        "{}",
        outcome.stderr
    );
    for (arguments, code, says) in [
        (vec!["--live", "here"], 2, "PORT, IP or IP:PORT"),
        (vec!["--pace", "2"], 2, "--live"),
        (vec!["--live", "0", "--pace", "-1"], 1, "a pace of -1"),
        (vec!["--live", "0", "--pace", "nan"], 1, "a pace of NaN"),
    ] {
        let outcome = run_slam(&log, &arguments);
        assert_eq!(outcome.code, code, "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(says), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stdout.is_empty(), "{}", outcome.stdout);
    }
}

#[cfg(not(feature = "live"))]
#[test]
fn without_the_feature_the_option_says_how_to_get_it() {
    let scratch = Scratch::new();
    let log = scratch.file("walk.txt", walk(5));
    for arguments in [&["--live"][..], &["--live", "8766"], &["--live", "0", "--pace", "2"]] {
        let outcome = run_slam(&log, arguments);
        assert_eq!(outcome.code, 2, "{}", outcome.stderr);
        assert!(outcome.stderr.contains("--features live"), "{}", outcome.stderr);
    }
}
