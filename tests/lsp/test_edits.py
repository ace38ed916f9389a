"""What the server proposes to write: other names, one layout, quick fixes. Nothing is written by itself."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest

from archgen.edit.formatted_slices import format_text
from tests.lsp.client import Client
from tests.lsp.conftest import Workspace
from tests.running import contents

STATE, ACTION = "groups/robot_state.yaml", "groups/robot_action_planner.yaml"
LAYOUT = {"tabSize": 2, "insertSpaces": True}


def apply_edit(texts: dict[str, str], folder: Path, edit: dict[str, Any]) -> dict[str, str]:
    """Return the texts of files with an edit of the workspace made in them."""
    changed = dict(texts)
    for change in edit["documentChanges"]:
        file = str(Path(change["textDocument"]["uri"].removeprefix("file://")).relative_to(folder))
        text = changed.get(file) or (folder / file).read_text(encoding="utf-8")
        changed[file] = apply_text_edits(text, change["edits"])
    return changed


def apply_text_edits(text: str, edits: list[dict[str, Any]]) -> str:
    """Return a text with edits made in it."""
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)

    def offset(position: dict[str, int]) -> int:
        return starts[position["line"]] + position["character"]

    for each in sorted(edits, key=lambda each: offset(each["range"]["start"]), reverse=True):
        start, end = offset(each["range"]["start"]), offset(each["range"]["end"])
        text = text[:start] + each["newText"] + text[end:]
    return text


RENAMES = [
    (STATE, "wheel_odometry: {from: base_con|troller.odometry", "wheel_controller", 5),
    (STATE, "wheel_odometry: {from: base_controller.odom|etry", "motion", 3),
    (STATE, "      hand_contact_mon|itor:", "palm_monitor", 2),
    (STATE, "requirements: [R-61, R-6|2]", "R-62-b", 3),
    (STATE, "owner: sss|a", "santanna", 3),
    (STATE, "          pose: Robot| pose", "Pose of the robot", 2),
    (STATE, "odom: {parent: map, by: am|cl", "localiser", 3),
    ("timing.yaml", "  contact_to_st|op:", "touch_to_stop", 1),
    ("nodes/devices.yaml", "namespace: /hand\n    host: arm|_pc", "arm_computer", 3),
]


@pytest.mark.parametrize(
    ("file", "snippet", "name", "least"),
    [pytest.param(*row, id=row[2], marks=() if number < 1 else pytest.mark.slow) for number, row in enumerate(RENAMES)],
)
def test_a_rename_there_and_back_changes_nothing(
    robot: Workspace, file: str, snippet: str, name: str, least: int
) -> None:
    client = robot.client
    on_disk = contents(client.folder)
    place = robot.find(file, snippet)
    old = client.at("prepareRename", *place)["placeholder"]
    edit: Any = client.at("rename", *place, newName=name)
    renamed = apply_edit(robot.texts, client.folder, edit)
    changed = [each for each in renamed if renamed[each] != robot.texts.get(each)]
    assert len(changed) >= least
    before = {each: robot.read(each) for each in changed}
    try:
        for each in changed:
            client.write(each, renamed[each])
        line = renamed[file].split("\n")[place[1] - 1]
        column = line.index(name) + 1
        assert client.at("prepareRename", file, place[1], column)["placeholder"] == name
        back = apply_edit(renamed, client.folder, client.at("rename", file, place[1], column, newName=old))
        assert {each: back[each] for each in changed} == before
    finally:
        for each, text in before.items():
            client.write(each, text)
    assert contents(client.folder) == on_disk


@pytest.mark.parametrize(
    ("snippet", "name", "reason"),
    [
        ("wheel_odometry: {from: base_con|troller.odometry", "velocity_arbiter", "the name is taken"),
        ("wheel_odometry: {from: base_con|troller.odometry", "Not an id", "write `not_an_id`"),
        ("wheel_odometry: {from: base_con|troller.odometry", "base_controller", "is called so already"),
    ],
)
def test_a_rename_is_refused_in_words(robot: Workspace, snippet: str, name: str, reason: str) -> None:
    file, line, column = robot.find(STATE, snippet)
    position = {"line": line - 1, "character": column - 1}
    document = {"uri": robot.client.uri(file)}
    answer = robot.client.ask("textDocument/rename", {"textDocument": document, "position": position, "newName": name})
    assert answer["error"]["code"] == -32803
    assert reason in answer["error"]["message"]


def test_nothing_is_renamed_while_a_file_cannot_be_read(robot: Workspace) -> None:
    file, line, column = robot.find(STATE, "wheel_odometry: {from: base_con|troller.odometry")
    text = robot.read(file)
    robot.client.write(file, f"{text}x: {{")
    position = {"line": line - 1, "character": column - 1}
    document = {"uri": robot.client.uri(file)}
    answer = robot.client.ask("textDocument/rename", {"textDocument": document, "position": position, "newName": "b"})
    robot.client.write(file, text)
    assert answer["error"]["message"] == f"line {text.count(chr(10)) + 1} of {file} cannot be read; mend it first"


def test_there_is_nothing_to_rename_in_a_text(robot: Workspace) -> None:
    assert robot.ask("prepareRename", STATE, "# What moves| against what") is None


def test_the_layout_is_that_of_fmt(robot: Workspace) -> None:
    text = robot.read(STATE)
    untidy = text.replace("    title: Robot State", "    title:    Robot State") + "\n\n"
    robot.client.write(STATE, untidy)
    formatted = apply_text_edits(untidy, robot.client.of("formatting", STATE, options=LAYOUT))
    assert formatted == format_text(untidy)
    robot.client.write(STATE, formatted)
    assert robot.client.of("formatting", STATE, options=LAYOUT) == []
    robot.client.write(STATE, "a: [\n")
    document = {"uri": robot.client.uri(STATE)}
    answer = robot.client.ask("textDocument/formatting", {"textDocument": document, "options": LAYOUT})
    assert answer["error"]["code"] == -32803
    robot.client.write(STATE, text)


SLIPS = [
    (
        "role: filter\n        functionality: >-\n          Fuses",
        "role: filtre\n        functionality: >-\n          Fuses",
    ),
    (
        "role: filter\n        functionality: >-\n          Fuses",
        "role: Filter\n        functionality: >-\n          Fuses",
    ),
    ("{from: base_controller.odometry,", "{from: base_controler.odometry,"),
    ("{from: metric_map.grid,", "{from: metric_map.gird,"),
    ("owner: sssa", "owner: ssssa"),
    ("requirements: [R-61, R-62]", "requirments: [R-61, R-62]"),
    ("inertia: mobile_base.imu", "inertia: mobile_bse.imu"),
    ("parent: odom, by: ekf_filter", "parent: odom, by: ekf_fliter"),
    ("          odometry: {type: Odometry, frame: odom}", "          odometry: {type: Odometry, frame: odom"),
]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        pytest.param(*slip, id=slip[1][:40], marks=pytest.mark.slow if number % 4 else ())
        for number, slip in enumerate(SLIPS)
    ],
)
def test_the_first_fix_mends_a_slip(robot: Workspace, right: str, wrong: str) -> None:
    text = robot.read(STATE)
    assert text.count(right) == 1
    slipped = text.replace(right, wrong)
    robot.client.write(STATE, slipped)
    try:
        found = robot.client.wait_until(STATE, lambda found: any(each["severity"] == 1 for each in found))
        errors = [each for each in found if each["severity"] == 1]
        actions = robot.client.of("codeAction", STATE, range=errors[0]["range"], context={"diagnostics": errors})
        assert actions[0]["diagnostics"][0]["message"] == errors[0]["message"]
        mended = apply_edit({STATE: slipped}, robot.client.folder, actions[0]["edit"])
    finally:
        robot.client.write(STATE, text)
    assert mended[STATE] == text


@pytest.mark.slow
def test_no_preferred_fix_means_something_else(robot: Workspace) -> None:
    """Of slips at random a preferred fix makes what was there, or something that is still wrong."""
    text = robot.read(STATE)
    chance = random.Random(7)  # noqa: S311 - the same slips each time
    lines = text.split("\n")
    for _ in range(8):
        number = chance.choice([at for at, line in enumerate(lines) if "from:" in line or "role:" in line])
        column = chance.randrange(lines[number].index(":") + 2, len(lines[number]))
        slip = lines[number][:column] + lines[number][column + 1 :]
        slipped = "\n".join((*lines[:number], slip, *lines[number + 1 :]))
        robot.client.write(STATE, slipped)
        everything = {"start": {"line": 0, "character": 0}, "end": {"line": 999, "character": 0}}
        actions = robot.client.of("codeAction", STATE, range=everything, context={"diagnostics": []})
        for action in actions:
            if action.get("isPreferred"):
                assert apply_edit({STATE: slipped}, robot.client.folder, action["edit"])[STATE] == text
    robot.client.write(STATE, text)


def test_a_finding_can_be_silenced_and_all_that_is_certain_be_mended(tmp_path: Path) -> None:
    text = (
        "archgen: 1\ngroups:\n  g:\n    components:\n"
        "      eye: {role: Source, outputs: {o: std_msgs/msg/Bool}}\n      ear: {role: SOURCE}\n"
    )
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    folder = tmp_path.resolve()
    with Client(folder) as client:
        client.open("archgen.yaml")
        client.wait_until("archgen.yaml", lambda found: sum(each["severity"] == 1 for each in found) == 2)
        line = {"start": {"line": 4, "character": 0}, "end": {"line": 4, "character": 0}}
        actions = client.of("codeAction", "archgen.yaml", range=line, context={"diagnostics": []})
        (everything,) = (each for each in actions if each["kind"] == "source.fixAll")
        mended = apply_edit({}, folder, everything["edit"])["archgen.yaml"]
        assert mended == text.replace("Source", "source").replace("SOURCE", "source")
        client.write("archgen.yaml", mended)
        client.wait_until("archgen.yaml", lambda found: "unread-output" in {each["code"] for each in found})
        actions = client.of("codeAction", "archgen.yaml", range=line, context={"diagnostics": [], "only": ["quickfix"]})
        silence = next(each for each in actions if each["title"].startswith("silence `unread-output`"))
        silenced = apply_edit({"archgen.yaml": mended}, folder, silence["edit"])["archgen.yaml"]
        assert "Bool}}  # archgen: ignore[unread-output] \n" in silenced
        client.write("archgen.yaml", silenced)
        client.wait_until("archgen.yaml", lambda found: "unread-output" not in {each["code"] for each in found})
