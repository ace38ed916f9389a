"""Findings while somebody types: at rest what `archgen check` says, in between nothing that is not so."""

from __future__ import annotations

import functools
import random
import shutil
import time
from pathlib import Path
from typing import Any

import pytest

from archgen.emit.data.findings_data import findings_to_json
from archgen.pipeline import check_project
from tests.lsp.client import Client
from tests.lsp.conftest import Workspace
from tests.property_sizes import try_some
from tests.running import RAMCIP, ROOT

SEVERITIES = {"error": 1, "warning": 2, "note": 3}
SMALL = """\
archgen: 1
hosts: {pc: {cores: 1}}
groups:
  g:
    components:
      eye: {outputs: {o: std_msgs/msg/Bool, spare: std_msgs/msg/Bool}}
      brake: {inputs: {i: eye.o}}
nodes:
  eye: {implements: eye, host: pc, timing: {period: 100 ms, wcet: 50 ms, bcet: 5 ms, priority: 3}}
"""


def simplify_check(folder: Path) -> list[tuple[Any, ...]]:
    """Return what `archgen check --format json` says of a project, as the protocol has it."""
    found = []
    for each in findings_to_json(check_project(folder).findings)["diagnostics"]:
        start, end = each["span"]["start"], each["span"]["end"]
        labels = [
            (label["span"]["file"], label["span"]["start"]["line"] - 1, label["text"]) for label in each["labels"]
        ]
        place = (each["span"]["file"], start["line"] - 1, start["column"] - 1, end["line"] - 1, end["column"] - 1)
        found.append((*place, each["rule"], SEVERITIES[each["severity"]], each["message"], each["help"], labels))
    return sorted(found, key=str)


def simplify_published(client: Client) -> list[tuple[Any, ...]]:
    """Return what was published last of all files, in the same form."""
    found = []
    for file, publication in client.diagnostics.items():
        for each in publication["diagnostics"]:
            start, end = each["range"]["start"], each["range"]["end"]
            message, *further = each["message"].split("\n")
            helps = [line.removeprefix("help: ") for line in further if line.startswith("help: ")]
            labels = [
                (
                    str(Path(label["location"]["uri"].removeprefix("file://")).relative_to(client.folder)),
                    label["location"]["range"]["start"]["line"],
                    label["message"],
                )
                for label in each.get("relatedInformation", [])
            ]
            place = (file, start["line"], start["character"], end["line"], end["character"])
            found.append((*place, each["code"], each["severity"], message, helps[0] if helps else None, labels))
    return sorted(found, key=str)


def _is_published(client: Client, expected: object) -> bool:
    return simplify_published(client) == expected


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param("example_ramcip", marks=pytest.mark.slow), "examples/arm"])
def test_at_rest_it_says_what_a_check_says(tmp_path: Path, name: str) -> None:
    folder = (tmp_path / "p").resolve()
    shutil.copytree(ROOT / name, folder, ignore=shutil.ignore_patterns("archgen-out"))
    chance = random.Random(name)  # noqa: S311 - the same edits each time
    files = [file for file in check_project(folder).yaml_files if not file.startswith("..")]
    compared = 0
    with Client(folder) as client:
        texts = {file: client.open(file) for file in files}
        for _ in range(5):
            file = chance.choice(files)
            lines = texts[file].split("\n")
            number = chance.choice([at for at, line in enumerate(lines) if ":" in line and "#" not in line])
            line = lines[number]
            column = chance.randrange(len(line) + 1)
            lines[number] = line[:column] + chance.choice(["x", "", "_a"]) + line[column + 1 :]
            texts[file] = "\n".join(lines)
            client.write(file, texts[file])
            client.rest(3.0)
            (folder / file).write_text(texts[file], encoding="utf-8")
            expected = simplify_check(folder)
            if any(each[5] == "syntax-error" for each in expected):  # then more is told here than by a check
                texts[file] = texts[file].replace(lines[number], line)
                client.write(file, texts[file])
                (folder / file).write_text(texts[file], encoding="utf-8")
                continue
            # After a while on a machine with nothing else to do.
            client.receive(functools.partial(_is_published, client, expected))
            compared += 1
    assert compared > 1


def test_an_open_file_gets_an_answer_for_each_version(robot: Workspace) -> None:
    text = robot.read("hardware.yaml")
    for number in range(3):
        robot.client.write("hardware.yaml", f"{text}# {number}\n")
        assert robot.client.wait_for("hardware.yaml") == []
    robot.client.write("hardware.yaml", text)


def test_only_what_changed_is_told_again(robot: Workspace) -> None:
    robot.read("timing.yaml")
    robot.client.rest(3)
    repeated: list[str] = []
    take = robot.client.diagnostics

    class Recording(dict[str, Any]):
        def __setitem__(self, file: str, publication: Any) -> None:  # noqa: ANN401 - what the protocol has
            known = self.get(file, {})
            if [known.get(key) for key in ("diagnostics", "version")] == [
                publication.get(key) for key in ("diagnostics", "version")
            ]:
                repeated.append(file)
            super().__setitem__(file, publication)

    robot.client.diagnostics = Recording(take)
    robot.client.write("timing.yaml", f"{robot.read('timing.yaml')}# more\n")
    robot.client.rest(3)
    robot.client.write("timing.yaml", robot.read("timing.yaml"))
    robot.client.diagnostics = take
    assert repeated == []


def test_a_wrong_name_is_told_when_nobody_types_it_any_more(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(SMALL, encoding="utf-8")
    with Client(tmp_path.resolve()) as client:
        client.open("archgen.yaml")
        client.wait_for("archgen.yaml")
        client.write("archgen.yaml", SMALL.replace("i: eye.o}", "i: eye.p}"))
        assert "unknown-reference" not in {each["code"] for each in client.wait_for("archgen.yaml")}
        told = client.wait_until("archgen.yaml", lambda findings: any(each["severity"] == 1 for each in findings))
        (error,) = (each for each in told if each["severity"] == 1)
        assert error["code"] == "unknown-reference"
        assert error["range"] == {"start": {"line": 6, "character": 26}, "end": {"line": 6, "character": 31}}
        assert error["codeDescription"]["href"].endswith("docs/rules/unknown-reference.md")
        client.write("archgen.yaml", SMALL)
        assert all(each["severity"] > 1 for each in client.wait_for("archgen.yaml"))


def test_an_unread_output_is_shown_as_unneeded(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(SMALL, encoding="utf-8")
    with Client(tmp_path.resolve()) as client:
        client.open("archgen.yaml")
        tags = {each["code"]: each.get("tags") for each in client.wait_for("archgen.yaml")}
    assert tags["unread-output"] == [1]


@pytest.mark.parametrize(("encoding", "column"), try_some([("utf-16", 13), ("utf-32", 12)]))
def test_columns_are_counted_as_the_client_wants(tmp_path: Path, encoding: str, column: int) -> None:
    text = "archgen: 1\ngroups:\n  g: {title: 🤖, owner: nobody}\n"
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    with Client(tmp_path.resolve(), (encoding,)) as client:
        client.open("archgen.yaml")
        (error,) = (each for each in client.wait_for("archgen.yaml") if each["severity"] == 1)
        assert error["range"]["start"]["character"] == column + 11
        definition = client.at("hover", "archgen.yaml", 3, 3)
        assert "🤖" in definition["contents"]["value"]


def test_typing_a_line_takes_nothing_else_down(robot: Workspace) -> None:
    file = "groups/robot_state.yaml"
    text = robot.read(file)
    line = "          wheel_odometry: {from: base_controller.odometry, type: Odometry}"
    assert text.count(line) == 1
    typed_line = text[: text.index(line)].count("\n")
    for length in range(0, len(line), 5):
        robot.client.write(file, text.replace(line, line[:length]))
        outside = [each for each in robot.client.wait_for(file) if each["range"]["start"]["line"] != typed_line]
        assert outside == [], line[:length]
    robot.client.write(file, text)
    assert robot.client.wait_for(file) == []


def test_a_change_on_the_disk_is_seen(tmp_path: Path) -> None:
    folder = tmp_path.resolve()
    (folder / "archgen.yaml").write_text(SMALL, encoding="utf-8")
    (folder / "more.yaml").write_text("nodes:\n  brake: {implements: brake, host: pc}\n", encoding="utf-8")
    with Client(folder) as client:
        client.open("archgen.yaml")
        client.wait_for("archgen.yaml")
        time.sleep(0.1)
        (folder / "more.yaml").write_text("nodes:\n  brake: {implements: brak, host: pc}\n", encoding="utf-8")
        client.wait_until("more.yaml", lambda found: [each["code"] for each in found[:1]] == ["unknown-reference"])


def test_a_closed_file_is_as_it_is_on_the_disk(tmp_path: Path) -> None:
    folder = tmp_path.resolve()
    (folder / "archgen.yaml").write_text(SMALL, encoding="utf-8")
    (folder / "more.yaml").write_text("nodes:\n  brake: {implements: brake, host: pc}\n", encoding="utf-8")
    with Client(folder) as client:
        client.open("archgen.yaml")
        client.write("more.yaml", "nodes:\n  brake: {implements: brak, host: pc}\n")
        client.wait_until("more.yaml", lambda found: any(each["severity"] == 1 for each in found))
        client.close("more.yaml")
        client.wait_until("more.yaml", lambda found: all(each["severity"] > 1 for each in found))


@pytest.mark.slow
def test_a_key_takes_less_than_a_check(tmp_path: Path) -> None:
    """In processor time: ratios in one run, since nothing else holds on a busy machine."""
    folder = tmp_path.resolve() / "p"
    shutil.copytree(RAMCIP, folder, ignore=shutil.ignore_patterns("archgen-out"))
    from archgen.live.warm_project import EditedProject

    project = EditedProject(folder)
    file = "groups/robot_state.yaml"
    text = (folder / file).read_text(encoding="utf-8")
    project.check_wholly()
    start = time.process_time()
    for number in range(5):
        project.set_text(file, f"{text}# {'x' * number}\n")
        project.check_quickly()
    per_key = (time.process_time() - start) / 5
    start = time.process_time()
    check_project(folder)
    assert per_key < 0.5 * (time.process_time() - start)
