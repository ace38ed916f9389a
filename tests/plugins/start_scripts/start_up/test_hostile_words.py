"""Words of the model reach programs as they are: nothing in them is read by a shell, by systemd or by compose."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import pytest
import yaml

from tests.plugins.start_scripts.start_up.started_workspaces import (
    Run,
    Stage,
    check_by_shellcheck,
    check_by_systemd,
    make_workspace,
)

WORDS = [
    "$(touch trace)",
    "`touch trace`",
    "${HOME}",
    "$HOME",
    "%h %% %n",
    "'; touch trace; '",
    '"; touch trace; "',
    "a\\nb \\",
    "\\",
    "line\nbreak",
    "\ttab ",
    ";",
    "#no",
    "--",
    "-n",
    "*",
    "!x",
    "{a,b}",
    "ü 漢字 😀",
    "{{ item }} {% x %}",
    "x=y",
    ": {a: b}",
    "",
]
TITLE = "Title\\n$(touch trace) `touch trace` % \\"


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hostile")
    project = {
        "archgen": 1,
        "project": {"id": "robot", "title": TITLE},
        "groups": {"g": {"components": {"a": {"title": TITLE}}}},
        "nodes": {
            "a": {
                "implements": "a",
                "title": TITLE,
                "kind": "program",
                "command": ["camera", *WORDS],
                "host": "box",
                "start": {
                    "environment": {"HOSTILE": "\0".join(" ".join(WORDS)), "NO": "no"},
                    "directory": "-a $(touch trace) %h",
                    "ready": {"log": "$(touch trace)\\ %n 'x' \"y\"", "within": "90 s"},
                },
            }
        },
        "hosts": {"box": {"title": TITLE, "hints": {"start": {"image": "x:${Y} $(touch trace)"}}}},
    }
    (folder / "project").mkdir()
    (folder / "project" / "archgen.yaml").write_text(json.dumps(project, ensure_ascii=False), encoding="utf-8")
    return make_workspace(folder / "project", folder / "ws")


def test_a_shell_reads_nothing_of_them(workspace: Path, tmp_path: Path) -> None:
    stage = Stage(tmp_path / "stage", {"camera": "a"}, says={"a": "$(touch trace)\\ %n 'x' \"y\""})
    (workspace / "-a $(touch trace) %h").mkdir(exist_ok=True)
    run = Run(workspace / "start.sh", stage)
    run.wait_for("up        all: 1 step,")
    run.send(signal.SIGINT)
    assert run.wait_for_end() == 0
    (told,) = stage.read_told("a")
    assert told["words"] == ["camera", *WORDS]
    assert told["environment"]["HOSTILE"] == " ".join(WORDS)
    assert told["folder"] == str(workspace / "-a $(touch trace) %h")
    assert not list(workspace.rglob("trace"))


def read_unit_words(line: str) -> list[str]:
    """Return the words of a command as systemd reads them: quotes, escapes, specifiers, variables."""
    words: list[str] = []
    place = 0
    while place < len(line):
        if line[place] != '"':
            end = line.find(" ", place)
            end = len(line) if end < 0 else end
            words.append(line[place:end])
            place = end + 1
            continue
        place, word = place + 1, ""
        while line[place] != '"':
            pair = line[place : place + 2]
            if pair[0] == "\\":
                word += {"n": "\n", "t": "\t", "r": "\r", '"': '"', "\\": "\\"}[pair[1]]
            elif pair[0] in "%$":
                assert pair[1] == pair[0], "a specifier or a variable"
                word += pair[0]
            else:
                word += pair[0]
            place += 2 if pair[0] in "\\%$" else 1
        words.append(word)
        place += 2
    return words


def test_systemd_reads_nothing_of_them(workspace: Path) -> None:
    unit = (workspace / "start" / "systemd" / "box" / "robot-a.service").read_text(encoding="utf-8")
    (line,) = [line for line in unit.split("\n") if line.startswith("ExecStart=")]
    words = read_unit_words(line.partition("=")[2])
    assert words[-len(WORDS) - 1 :] == ["camera", *WORDS]
    assert f"HOSTILE={' '.join(WORDS)}" in words
    assert "-a $(touch trace) %h" in words
    watching = (workspace / "start" / "systemd" / "box" / "robot-a-up.service").read_text(encoding="utf-8")
    (line,) = [line for line in watching.split("\n") if line.startswith("ExecStart=")]
    assert "$(touch trace)\\ %n 'x' \"y\"" in read_unit_words(line.partition("=")[2])
    units = sorted((workspace / "start" / "systemd" / "box").iterdir())
    check_by_systemd(*units)


def test_compose_reads_nothing_of_them(workspace: Path) -> None:
    text = (workspace / "start" / "compose" / "box.yaml").read_text(encoding="utf-8")
    service = yaml.safe_load(text)["services"]["a"]
    assert service["environment"]["NO"] == "no"
    words = [
        word.replace("$$", "\0")
        for word in [
            *service["command"],
            service["image"],
            service["environment"]["HOSTILE"],
            *service["healthcheck"]["test"],
        ]
    ]
    assert not [word for word in words if "$" in word]
    plain = [word.replace("\0", "$") for word in words]
    assert plain[: len(service["command"])][-len(WORDS) - 1 :] == ["camera", *WORDS]
    assert "x:${Y} $(touch trace)" in plain
    assert " ".join(WORDS) in plain


def test_shellcheck_finds_nothing(workspace: Path) -> None:
    scripts = sorted(workspace.rglob("*.sh"))
    check_by_shellcheck(*scripts)
