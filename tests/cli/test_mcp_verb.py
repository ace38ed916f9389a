"""`archgen mcp`: asked by the protocol's own client; answers are those of verbs, nothing is written unasked."""

from __future__ import annotations

import asyncio
import json
import sys
from pathlib import Path
from typing import Any

import pytest

from archgen.cli.mcp_command import make_server
from tests.cli.conftest import ROOT, Run

ROBOT = ROOT / "example_ramcip"
TEXT = "archgen: 1\ngroups:\n  sense:\n    components:\n      eye: {outputs: {image: Image}}\n      screen: {inputs: {image: eye.image}}\n"


async def _ask(server: object, questions: list[tuple[str, dict[str, Any]]]) -> list[tuple[bool, str]]:
    # To import it takes longer than these tests: it is left to the process that runs them.
    from mcp import Client

    async with Client(server) as client:  # type: ignore[arg-type] # a server or how to start one
        answers = [await client.call_tool(name, arguments) for name, arguments in questions]
        return [(bool(each.is_error), "".join(getattr(part, "text", "") for part in each.content)) for each in answers]


def ask(server: object, *questions: tuple[str, dict[str, Any]]) -> list[tuple[bool, str]]:
    return asyncio.run(_ask(server, list(questions)))


@pytest.mark.slow
def test_answers_are_those_of_the_verbs(run: Run) -> None:
    answers = ask(
        make_server(ROBOT),
        ("check", {}),
        ("check", {"select": "owner:tum"}),
        ("show", {"words": ["navigator"]}),
        ("find", {"words": "fall alarm"}),
        ("chains", {}),
        ("what_if", {"settings": ["scanner_front.timing.rate=20Hz"]}),
        ("show", {"words": ["navigatr"]}),
        ("show", {"words": ["--help"]}),
    )
    verbs = [
        ("check", ROBOT),
        ("check", ROBOT, "--select", "owner:tum"),
        ("show", "navigator", "-C", ROBOT),
        ("find", "fall alarm", "-C", ROBOT),
        ("timing", ROBOT),
        ("timing", ROBOT, "--set", "scanner_front.timing.rate=20Hz"),
    ]
    for (is_error, text), words in zip(answers, verbs, strict=False):
        assert not is_error
        assert text == run(*words, "--format", "json").out
    assert [is_error for is_error, _ in answers[len(verbs) :]] == [True, True]
    assert "did you mean" in answers[-2][1]


def test_a_proposal_is_judged_before_it_is_written(tmp_path: Path) -> None:
    file = tmp_path / "archgen.yaml"
    file.write_text(TEXT)
    server = make_server(tmp_path, allow_writes=True)

    def propose(*edits: tuple[str, str, str]) -> tuple[str, dict[str, Any]]:
        return "propose", {"edits": [dict(zip(("file", "old", "new"), edit, strict=True)) for edit in edits]}

    slip = ("archgen.yaml", "      screen:", "      lamp: {inputs: {image: eye.imgae}}\n      screen:")
    good = ("archgen.yaml", "      screen:", "      lamp: {inputs: {image: eye.image}}\n      screen:")
    answers = ask(
        server,
        propose(slip),
        ("apply", {"proposal": 1}),
        propose(good),
        ("apply", {"proposal": 2}),
        ("apply", {"proposal": 2}),
        propose(good),
        propose(("archgen.yaml", "      lamp:", "      light:"), ("more.yaml", "", "types: {Sound: {}}\n")),
    )
    assert [is_error for is_error, _ in answers] == [False, True, False, False, True, False, False]
    wrong = json.loads(answers[0][1])
    assert [(each["rule"], each["help"]) for each in wrong["new"]] == [
        ("unknown-reference", "did you mean `eye.image`?")
    ]
    assert "it would bring 1 errors" in answers[1][1]
    assert "+      lamp: {inputs: {image: eye.image}}" in json.loads(answers[2][1])["patch"]
    assert {each["severity"] for each in json.loads(answers[2][1])["new"]} <= {"note", "warning"}
    assert json.loads(answers[3][1])["written"] == ["archgen.yaml"]
    assert file.read_text() == TEXT.replace(*good[1:])
    assert "--- /dev/null" in json.loads(answers[6][1])["patch"]
    file.write_text(TEXT)  # somebody else was there since
    before = sorted(tmp_path.iterdir())
    ((is_error, text),) = ask(server, ("apply", {"proposal": 4}))
    assert (is_error, sorted(tmp_path.iterdir()), file.read_text()) == (True, before, TEXT), text


@pytest.mark.parametrize(
    ("file", "old", "reason"),
    [
        ("../other.yaml", "", "lies outside of the project"),
        ("/etc/passwd", "root", "lies outside of the project"),
        ("notes.txt", "secret", "none of the project's own files"),
        ("link.yaml", "secret", "none of the project's own files"),
        ("archgen.yaml", "image", "stands there 3 times"),
        ("archgen.yaml", "nothing like it", "is not in it"),
        ("archgen.yaml", "", "the file is there"),
    ],
)
def test_what_cannot_be_proposed_is_refused_in_words(tmp_path: Path, file: str, old: str, reason: str) -> None:
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot/archgen.yaml").write_text(TEXT)
    (tmp_path / "robot/notes.txt").write_text("secret")
    (tmp_path / "secret.yaml").write_text("secret")
    (tmp_path / "robot/link.yaml").symlink_to(tmp_path / "secret.yaml")
    edit = {"file": file, "old": old, "new": "x"}
    ((is_error, text), (unknown, _)) = ask(
        make_server(tmp_path / "robot"), ("propose", {"edits": [edit]}), ("apply", {"proposal": 1})
    )
    assert (is_error, reason in text) == (True, True), text
    assert unknown, "there is no such tool without --allow-writes"


def test_the_verb_speaks_on_its_streams(tmp_path: Path) -> None:
    from mcp import StdioServerParameters

    (tmp_path / "archgen.yaml").write_text(TEXT)
    words = ["-m", "archgen", "mcp", "-C", str(tmp_path)]
    ((is_error, text),) = ask(StdioServerParameters(command=sys.executable, args=words), ("find", {"words": "eye"}))
    assert (is_error, json.loads(text)["found"][0]["id"]) == (False, "sense.eye")


def test_without_the_package_it_says_what_to_install(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    ran = run("mcp")
    assert (ran.status, 'pip install "archgen[mcp]"' in ran.err) == (2, True)
