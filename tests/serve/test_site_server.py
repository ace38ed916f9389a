"""The preview over HTTP: what it sends, to whom, and how it begins and ends."""

from __future__ import annotations

import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from archgen.cli import main
from archgen.serve import site_server
from archgen.serve.live_site import LiveSite
from archgen.serve.site_server import SiteServer
from tests.serve.conftest import ROBOT

JSON = {"Content-Type": "application/json"}


class Reply:
    """What the server sends back."""

    def __init__(self, response: http.client.HTTPResponse) -> None:
        self.status, self.data = response.status, response.read()
        self.headers = dict(response.getheaders())

    def json(self) -> Any:  # noqa: ANN401 - whatever it is
        """Return what was sent as JSON."""
        return json.loads(self.data)


def ask(server: SiteServer, path: str, method: str = "GET", body: bytes | None = None, **headers: str) -> Reply:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=600)
    try:
        connection.request(method, path, body, {name.replace("_", "-"): text for name, text in headers.items()})
        return Reply(connection.getresponse())
    finally:
        connection.close()


def question(server: SiteServer, *overrides: object, **headers: str) -> Reply:
    return ask(
        server,
        "/live/what-if",
        "POST",
        json.dumps({"set": overrides}).encode(),
        **{"Content_Type": JSON["Content-Type"], **headers},
    )


def test_pages_scripts_and_pictures_have_their_types(server: SiteServer) -> None:
    for path, content_type in {
        "/": "text/html; charset=utf-8",
        "/index.html?q=x": "text/html; charset=utf-8",
        "/components/g%2eeye.html": "text/html; charset=utf-8",
        "/live/live.js": "text/javascript; charset=utf-8",
        "/assets/site.css": "text/css; charset=utf-8",
        "/figures/overview.svg": "image/svg+xml",
        "/pictures/docs/dot.png": "image/png",
    }.items():
        reply = ask(server, path)
        assert (reply.status, reply.headers["Content-Type"]) == (200, content_type)
        assert int(reply.headers["Content-Length"]) == len(reply.data) > 0
        head = ask(server, path, "HEAD")
        assert (head.status, head.headers["Content-Type"], head.data) == (200, content_type, b"")


def test_nothing_is_kept_guessed_framed_or_handed_to_other_sites(server: SiteServer) -> None:
    for path in ("/", "/nothing", "/live/what-if?chain=stop"):
        headers = ask(server, path).headers
        assert headers["Cache-Control"] == "no-store"
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
        assert headers["Content-Security-Policy"] == "frame-ancestors 'none'"
        assert "Access-Control-Allow-Origin" not in headers


def test_an_editor_that_starts_it_may_frame_it_and_nobody_else(server: SiteServer) -> None:
    in_editor = SiteServer(server.live_site, "127.0.0.1", 0, in_editor=True)
    threading.Thread(target=in_editor.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True).start()
    try:
        policy = ask(in_editor, "/").headers["Content-Security-Policy"]
    finally:
        in_editor.shutdown()
        in_editor.server_close()
    assert policy == "frame-ancestors vscode-webview: https://*.vscode-cdn.net"


@pytest.mark.parametrize(
    "path",
    [
        "/archgen.yaml",
        "/../robot/archgen.yaml",
        "/%2e%2e/robot/archgen.yaml",
        "/..%2frobot%2farchgen.yaml",
        "/assets/..%5c..%5carchgen.yaml",
        "//etc/passwd",
        "/etc/passwd",
        "/components/",
        "/assets",
        "/live/",
        "/%00",
        "/index.html%00.png",
    ],
)
def test_there_is_nothing_but_the_site(server: SiteServer, path: str) -> None:
    reply = ask(server, path)
    assert reply.status == 404
    assert b"archgen: 1" not in reply.data
    assert b"<" not in reply.data


def test_foreign_hosts_and_origins_are_refused(server: SiteServer) -> None:
    own = f"127.0.0.1:{server.server_port}"
    for headers in (
        {"Host": "evil.example"},
        {"Host": f"evil.example:{server.server_port}"},
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Sec_Fetch_Site": "cross-site", "Sec_Fetch_Mode": "no-cors"},
    ):
        for path in ("/", "/live/news", "/assets/search/index.js"):
            assert ask(server, path, "GET", None, **headers).status == 403
        assert question(server, "eye.timing.wcet=6 ms", **headers).status == 403
    assert ask(server, "/", Host=own, Origin=f"http://{own}").status == 200
    with socket.create_connection(("127.0.0.1", server.server_port), 10) as raw:
        raw.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n")
        assert b" 403 " in raw.recv(1000)


def test_other_methods_are_refused(server: SiteServer) -> None:
    for method in ("PUT", "DELETE", "OPTIONS", "TRACE"):
        assert ask(server, "/index.html", method).status == 501
    assert ask(server, "/index.html", "POST", b"{}", Content_Type=JSON["Content-Type"]).status == 404


def test_a_question_is_answered_as_the_command_line_does(server: SiteServer, robot: Path) -> None:
    overrides = ["eye.timing.wcet=150 ms", "eye.timing.period=1 s"]
    answer = question(server, *overrides).json()
    words = ["timing", str(robot), "--format", "json", *(word for text in overrides for word in ("--set", text))]
    expected = json.loads(CliRunner().invoke(main, words).stdout)
    assert {name: answer[name] for name in expected} == expected
    assert answer["rows"][0] == {
        "kind": "chain",
        "id": "stop",
        "title": "Stops in time",
        "now": {"figure": "110 ms", "status": "met", "margin": "90 ms left"},
        "then": {"figure": "1.16 s", "status": "missed", "margin": "seen +955 ms"},
        "difference": "+1.05 s",
        "differs": True,
    }
    assert [(row["kind"], row["id"]) for row in answer["rows"][1:]] == [("host", "pc")]


def test_a_question_that_makes_no_sense_is_answered_in_the_words_of_set(server: SiteServer) -> None:
    for override, words in {
        "eye.timing.wcet=fast": "`wcet` takes a duration such as 120 ms",
        "ey.timing.wcet=5 ms": "nothing is called `ey`; did you mean `eye`?",
        "eye.timing.wct=5 ms": "`timing` has no key `wct` that can be set; did you mean `wcet`?",
        "eye.host=bx": "`host` takes a host; did you mean `box`?, not `bx`",
        "nonsense": "`nonsense` is not ELEMENT.timing.KEY=VALUE",
    }.items():
        assert question(server, override).json()["error"].startswith(words)


@pytest.mark.parametrize(
    "body", [b"", b"{", b"[]", b'{"set": "x"}', b'{"set": [1]}', b"[" * 90_000, b'{"set": ' + b'["x=1"]' * 9 + b"}"]
)
def test_what_is_no_question_is_refused(server: SiteServer, body: bytes) -> None:
    reply = ask(server, "/live/what-if", "POST", body, Content_Type=JSON["Content-Type"])
    assert reply.status == 400
    assert reply.json()["error"].startswith("ask with ")


def test_questions_are_limited(server: SiteServer) -> None:
    assert "at most 200 figures" in question(server, *["a=1"] * 201).json()["error"]
    assert "in at most 500 letters" in question(server, f"a={'1' * 600}").json()["error"]
    assert ask(server, "/live/what-if", "POST", b"x" * 100_001, Content_Type=JSON["Content-Type"]).status == 413
    # A form of another site may send any text, but not as JSON.
    assert ask(server, "/live/what-if", "POST", b'{"set": []}', Content_Type="text/plain").status == 415
    with socket.create_connection(("127.0.0.1", server.server_port), 10) as raw:
        head = (
            f"POST /live/what-if HTTP/1.1\r\nHost: localhost:{server.server_port}\r\nContent-Type: application/json\r\n"
        )
        raw.sendall(f"{head}Transfer-Encoding: chunked\r\n\r\n".encode())
        assert b" 411 " in raw.recv(1000)


def test_the_figures_of_a_chain_are_those_that_can_be_set(server: SiteServer) -> None:
    figures = ask(server, "/live/what-if?chain=stop").json()["figures"]
    assert [(each["set"], each["value"]) for each in figures] == [
        ("eye.timing.wcet", "5 ms"),
        ("eye.timing.period", "100 ms"),
        ("eye.timing.priority", "3"),
        ("eye.host", "pc"),
        ("brake.timing.wcet", "5 ms"),
        ("brake.timing.priority", ""),
        ("brake.host", "pc"),
    ]
    tried = {"wcet": "7 ms", "period": "50 ms", "priority": "9", "host": "box"}
    for figure in figures:
        assert question(server, f"{figure['set']}={tried[figure['set'].rpartition('.')[2]]}").status == 200
    assert ask(server, "/live/what-if?chain=nothing").json() == {"figures": []}


def test_the_figures_of_a_host_are_those_of_all_that_runs_on_it(server: SiteServer) -> None:
    figures = ask(server, "/live/what-if?host=pc").json()["figures"]
    assert {each["node"] for each in figures} == {"eye", "brake"}
    assert ask(server, "/live/what-if?host=nothing").json() == {"figures": []}


def test_news_come_when_a_file_has_changed(server: SiteServer, live_site: LiveSite, robot: Path) -> None:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=600)
    connection.request("GET", "/live/news")
    response = connection.getresponse()
    assert response.headers["Content-Type"] == "text/event-stream"

    def next_status() -> Any:  # noqa: ANN401 - the status as JSON
        while not (line := response.readline()).startswith(b"data: "):
            assert line
        return json.loads(line[6:])

    assert next_status()["errors"] == []
    (robot / "archgen.yaml").write_text(ROBOT.replace("functionality", "functionalty", 1))
    live_site.refresh()
    while not (status := next_status())["errors"]:
        pass
    assert status["outdated"] is True
    assert status["errors"][0]["help"] == "did you mean `functionality`?"
    connection.close()


def test_connections_beyond_those_that_may_be_open_are_ended(
    live_site: LiveSite, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(site_server, "MAX_CONNECTIONS", 2)
    server = SiteServer(live_site, "127.0.0.1", 0)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    address = ("127.0.0.1", server.server_port)
    held = [socket.create_connection(address, 120) for _ in range(2)]
    with socket.create_connection(address, 120) as third:
        assert third.recv(1) == b""
    for each in held:
        each.sendall(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
        assert each.recv(12).startswith(b"HTTP/1.1 ")
        each.close()
    server.shutdown()
    server.server_close()
    thread.join(120)


def serve(project: Path, *words: str) -> subprocess.Popen[str]:
    # Where the tests run in the background, they ignore what Ctrl-C sends, and so would what they start.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return subprocess.Popen(  # noqa: S603 - our own command line
            [sys.executable, "-m", "archgen", "serve", str(project), *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
        )
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.slow
def test_the_verb_serves_and_ends_cleanly_when_it_is_interrupted(robot: Path) -> None:
    process = serve(robot, "--port", "0")
    assert process.stdout is not None
    line = process.stdout.readline()
    address = re.fullmatch(r"serving Robot at http://127\.0\.0\.1:(\d+)/  \(Ctrl-C ends it\)\n", line)
    assert address, line
    taken = serve(robot, "--port", address[1])
    _, words = taken.communicate(timeout=600)
    assert (taken.returncode, words) == (
        2,
        f"Error: port {address[1]} of 127.0.0.1 is taken; `--port 0` takes a free one\n",
    )
    # One page waits for news, and must not hold up the end.
    with socket.create_connection(("127.0.0.1", int(address[1])), 120) as waiting:
        waiting.sendall(f"GET /live/news HTTP/1.1\r\nHost: localhost:{address[1]}\r\n\r\n".encode())
        assert b"200 OK" in waiting.recv(1000)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=600)
    assert (process.returncode, out, err.strip()) == (0, "", "stopped")
    assert not (robot / "archgen-out").exists()


def test_a_project_that_is_not_there_is_wrong_usage(tmp_path: Path) -> None:
    process = serve(tmp_path / "nothing", "--port", "0")
    _, err = process.communicate(timeout=600)
    assert process.returncode == 2
    assert "Traceback" not in err
    assert "nothing" in err


def test_an_address_that_is_not_of_this_machine_is_told(robot: Path) -> None:
    process = serve(robot, "--host", "203.0.113.7", "--port", "0")
    _, err = process.communicate(timeout=600)
    assert process.returncode == 2
    assert err.startswith("Error: cannot listen at 203.0.113.7, port 0: ")
