"""What the server says of places in files: where an element is declared, where it stands, what its card says."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from tests.lsp.conftest import Workspace

STATE, ACTION, CHAINS, CASES, TYPES = (
    "groups/robot_state.yaml",
    "groups/robot_action_planner.yaml",
    "timing.yaml",
    "use_cases.yaml",
    "ros_types.yaml",
)
DEFINITIONS = [
    # paths in inputs: the word under the cursor counts
    (STATE, "wheel_odometry: {from: base_con|troller.odometry", [f"{ACTION}: base_controller:"]),
    (STATE, "wheel_odometry: {from: base_controller.|odometry", [f"{ACTION}: odometry: Odometry"]),
    (STATE, "wheel_odometry: {from: base_controller.odometry|", [f"{ACTION}: odometry: Odometry"]),
    (STATE, "scans: |hardware.laser_scanners", ["hardware.yaml: hardware:"]),
    (STATE, "scans: hardware.laser_|scanners", ["hardware.yaml: laser_scanners:"]),
    (STATE, "inertia: mobile_base.|imu", ["hardware.yaml: imu: IMU"]),
    (STATE, "inertia: mobile|_base.imu", ["hardware.yaml: mobile_base:"]),
    (STATE, "map: {from: metric_map.gr|id", ["groups/environment_model.yaml: grid:"]),
    # a declaration leads to itself
    (STATE, "      hand_contact_mon|itor:", [f"{STATE}: hand_contact_monitor:"]),
    (STATE, "          pose|: Robot pose", [f"{STATE}: pose: Robot pose"]),
    # ids
    (STATE, "owner: sss|a", ["archgen.yaml: sssa:"]),
    (STATE, "requirements: [R-01, R-1|4, ", ["archgen.yaml: R-14:"]),
    (STATE, "requirements: [R-|61, R-62]", ["archgen.yaml: R-61:"]),
    (STATE, "          pose: Robot| pose", [f"{TYPES}: Robot pose:"]),
    (STATE, "odometry: {type: Odometry, frame: od|om}", [f"{STATE}: odom:"]),
    (STATE, "base_link: {parent: |odom", [f"{STATE}: odom:"]),
    (STATE, "odom: {parent: map, by: am|cl", ["nodes/perception.yaml: amcl:", "timing.yaml: amcl:"]),
    # nodes
    ("nodes/devices.yaml", "implements: hardware.hand_|drives", ["hardware.yaml: hand_drives:"]),
    ("nodes/devices.yaml", "namespace: /hand\n    host: arm|_pc", ["timing.yaml: arm_pc:"]),
    ("nodes/devices.yaml", "finger_|states: finger_states", ["hardware.yaml: finger_states:"]),
    ("nodes/devices.yaml", "      wrist_for|ce: wrist_force", ["hardware.yaml: wrist_force:"]),
    ("nodes/action.yaml", "implements: robot_action_planner.navi|gator", [f"{ACTION}: navigator:"]),
    ("nodes/action.yaml", "implements: robot_action|_planner.navigator", [f"{ACTION}: robot_action_planner:", "timing.yaml: robot_action_planner:"]),
    ("nodes/action.yaml", "nav2_bt_navigator::BtNavigator\n    status: existing\n    container: navi|gation", ["timing.yaml: navigation:"]),
    # chains, use cases, policies, views, variants
    (CHAINS, "through: [body_dri|ves, arm_state", ["hardware.yaml: body_drives:"]),
    (CHAINS, "[body_drives, arm_state_est|imator,", [f"{STATE}: arm_state_estimator:"]),
    (CHAINS, "requirements: [R-23, R-7|2]", ["archgen.yaml: R-72:"]),
    (CASES, "{from: home, to: head_ca|mera, say: the stick", ["hardware.yaml: head_camera:"]),
    (CASES, "{from: ho|me, to: head_camera, say: the stick", [f"{CASES}: home: The home"]),
    (CASES, "to: object_recog|nition, say: shows the hallway", ["groups/environment_state.yaml: object_recognition:"]),
    ("archgen.yaml", "R-80:\n    title: The resident pauses all recording with one touch\n    description: No partner has taken it yet; see the README.\n    source: Third review of the ethics board\n    use_cases: [UC-|7]", ["archgen.yaml: UC-7:", f"{CASES}: UC-7:"]),
    ("archgen.yaml", "forbid: {from: cognitive_rea|soning", ["groups/cognitive_reasoning.yaml: cognitive_reasoning:"]),
    ("archgen.yaml", "to: hardware.mobile|_base}", ["hardware.yaml: mobile_base:"]),
    ("archgen.yaml", 'show: "microphone_array touch_pan|el', ["hardware.yaml: touch_panel:"]),
    ("archgen.yaml", "emergency_stop_hand|ler+1 tag", [f"{ACTION}: emergency_stop_handler:"]),
    ("variants.yaml", "without: human_state.person_|identification", ["groups/human_state.yaml: person_identification:"]),
    ("variants.yaml", "        realsense_|head: {package", ["nodes/devices.yaml: realsense_head:", "timing.yaml: realsense_head:", "variants.yaml: realsense_head:"]),
    # messages of the project, and chapters
    (TYPES, "Held load: {message: ramcip_msgs/msg/Held|Load", ["msgs/ramcip_msgs/msg/HeldLoad.msg: "]),
    ("archgen.yaml", "chapters:\n    - docs/intro|duction.md", ["docs/introduction.md: "]),
    (TYPES, "IMU: {message: sensor_msgs/msg/I|mu", []),
    # what names nothing
    (STATE, "role: fil|ter\n        functionality: >-\n          Fuses", []),
    (STATE, "title: Base |Localisation", []),
    (STATE, "# What moves| against what", []),
]  # fmt: skip
INSTANCE_DEFINITIONS = [
    ("arms.yaml", "left_arm:\n        is: ar|m", ["types.yaml: arm:"]),
    ("arms.yaml", "inputs: {path: lift_planner.le|ft}", ["arms.yaml: left: Hand path"]),
    ("arms.yaml", "arms: [left_arm.sta|te", ["types.yaml: state:"]),
    ("arms.yaml", "arms: [left_|arm.state", ["arms.yaml: left_arm:"]),
    ("arms.yaml", "components: {hand: {components: {thu|mb:", ["types.yaml: thumb:", "arms.yaml: thumb:"]),
    ("types.yaml", "strong_joint:\n    is: contr|oller", ["types.yaml: controller:"]),
    ("types.yaml", "thumb: {is: fin|ger", ["types.yaml: finger:"]),
    ("types.yaml", "states: [thumb.st|ate, index", ["types.yaml: state: Joint state"]),
    ("types.yaml", "states: [thumb.state, ind|ex.state", ["types.yaml: index:"]),
    ("types.yaml", "outputs: {state: {from: gr|ip.state}}", ["types.yaml: grip:"]),
    ("types.yaml", "      target: Joint tar|get", ["archgen.yaml: Joint target:"]),
    ("archgen.yaml", "lift_planner, left_arm.mot|ion", ["types.yaml: motion:"]),
    ("archgen.yaml", "left_arm.motion, left_arm.el|bow", ["types.yaml: elbow:"]),
]


@pytest.mark.parametrize(("file", "snippet", "expected"), DEFINITIONS, ids=[row[1][-60:] for row in DEFINITIONS])
def test_definitions(robot: Workspace, file: str, snippet: str, expected: list[str]) -> None:
    check_definition(robot, file, snippet, expected)


@pytest.mark.parametrize(
    ("file", "snippet", "expected"), INSTANCE_DEFINITIONS, ids=[row[1][-60:] for row in INSTANCE_DEFINITIONS]
)
def test_definitions_in_types(arms: Workspace, file: str, snippet: str, expected: list[str]) -> None:
    check_definition(arms, file, snippet, expected)


def check_definition(workspace: Workspace, file: str, snippet: str, expected: list[str]) -> None:
    found: Any = workspace.ask("definition", file, snippet)
    lines = [workspace.line_at(location) for location in found or ()]
    assert len(lines) == len(expected), lines
    assert all(line.startswith(start) for line, start in zip(lines, expected, strict=True)), lines


def test_all_inputs_lead_to_the_output_that_they_name(robot: Workspace) -> None:
    """Not by the index, but by the words: `from: a.b` leads to the line of `b` below `a`."""
    count = 0
    for path in sorted((robot.client.folder / "groups").glob("*.yaml")):
        file = f"groups/{path.name}"
        for number, line in enumerate(robot.read(file).split("\n"), 1):
            for match in re.finditer(r"(?:from: |^ {10}\w+: )((?:\w+\.)?(\w+)\.(\w+))(?=[,}]|$)", line):
                found: Any = robot.client.at("definition", file, number, match.end(1))
                assert [robot.line_at(each).partition(": ")[2].startswith(f"{match[3]}:") for each in found] == [True]
                target = Path(found[0]["uri"].removeprefix("file://")).read_text(encoding="utf-8").split("\n")
                above = target[: found[0]["range"]["start"]["line"]]
                holders = [each.strip(" :") for each in above if re.match(r" {2,6}\w+:$", each)]
                assert match[2] in holders, line
                count += 1
    assert count > 100


REFERENCES = [
    (STATE, "wheel_odometry: {from: base_controller.odom|etry", [f"{ACTION}: odometry:", f"{STATE}: odometry, type", "nodes/action.yaml: odometry:"]),
    (STATE, "owner: sss|a", ["archgen.yaml: sssa:", f"{STATE}: sssa"]),
    ("variants.yaml", "without: human_state.person_|identification", ["groups/human_state.yaml: person_identification:", "variants.yaml: person_identification", "archgen.yaml: person_identification"]),
    (CASES, "{from: ho|me, to: head_camera, say: the stick", [f"{CASES}: home: The home", f"{CASES}: home, to: head_camera"]),
    (STATE, "odometry: {type: Odometry, frame: od|om}", [f"{STATE}: odom:", f"{STATE}: odom}}", f"{STATE}: odom, by: ekf"]),
    ("nodes/devices.yaml", "namespace: /hand\n    host: arm|_pc", ["timing.yaml: arm_pc:", "nodes/devices.yaml: arm_pc"]),
]  # fmt: skip


@pytest.mark.parametrize(("file", "snippet", "among"), REFERENCES, ids=[row[1][-40:] for row in REFERENCES])
def test_references(robot: Workspace, file: str, snippet: str, among: list[str]) -> None:
    found: Any = robot.ask("references", file, snippet, context={"includeDeclaration": True})
    lines = [robot.line_at(location) for location in found or ()]
    for start in among:
        assert any(line.startswith(start) for line in lines), (start, lines)
    word = among[0].partition(": ")[2].partition(":")[0]
    assert all(line.partition(": ")[2].startswith(word) for line in lines), lines
    without: Any = robot.ask("references", file, snippet, context={"includeDeclaration": False})
    assert 0 < len(without) < len(found)
    marks: Any = robot.ask("documentHighlight", file, snippet)
    own = [each for each in found if each["uri"] == robot.client.uri(file)]
    assert [mark["range"] for mark in marks] == [each["range"] for each in own]


CARDS = [
    (STATE, "wheel_odometry: {from: base_controller.odom|etry", ["**output** `robot_action_planner.base_controller.odometry`", "nav\\_msgs/msg/Odometry", "readers", "#L"]),
    (STATE, "wheel_odometry: {from: base_con|troller.odometry", ["**component** `robot_action_planner.base_controller`"]),
    (STATE, "  robot_st|ate:\n    title", ["**group** `robot_state`", "owner: accrea"]),
    (STATE, "requirements: [R-01, R-1|4, ", ["**requirement** `R-14`", "knows the rooms"]),
    (STATE, "owner: sss|a", ["**partner** `sssa`"]),
    (STATE, "          pose: Robot| pose", ["**type** `Robot pose`", "PoseWithCovarianceStamped"]),
    (TYPES, "Held load: {message: ramcip_msgs/msg/Held|Load", ["**msg** `ramcip_msgs/msg/HeldLoad`", "- `"]),
    (TYPES, "IMU: {message: sensor_msgs/msg/I|mu", ["**msg** `sensor_msgs/msg/Imu`", "orientation_covariance"]),
    (STATE, "        requirem|ents: [R-61, R-62]", ["`requirements` -"]),
    (STATE, "      hand_contact_monitor:\n        title: Hand Contact Monitor\n        owner: sssa\n        ro|le: filter", ["`role` -"]),
    ("nodes/devices.yaml", "namespace: /hand\n    host: arm|_pc", ["**host** `arm_pc`"]),
    ("nodes/devices.yaml", "  hand_dri|ver:", ["**node** `hand_driver`"]),
    (CHAINS, "  contact_to_|stop:", ["**chain** `contact_to_stop`", "60 ms"]),
    (CASES, "  UC-|1:\n    actors", ["**use case** `UC-1`"]),
]  # fmt: skip


@pytest.mark.parametrize(("file", "snippet", "words"), CARDS, ids=[row[1][-40:] for row in CARDS])
def test_cards(robot: Workspace, file: str, snippet: str, words: list[str]) -> None:
    card: Any = robot.ask("hover", file, snippet)
    assert card, snippet
    for word in words:
        assert word in card["contents"]["value"]


def test_a_text_has_no_card(robot: Workspace) -> None:
    assert robot.ask("hover", STATE, "# What moves| against what") is None


def test_the_outline_has_groups_components_and_ports(robot: Workspace) -> None:
    robot.read(STATE)
    groups, frames = robot.client.of("documentSymbol", STATE)
    assert (groups["name"], frames["name"]) == ("groups", "frames")
    (group,) = groups["children"]
    assert (group["name"], group["detail"]) == ("robot_state", "Robot State")
    component = group["children"][0]
    assert component["name"] == "base_localisation"
    assert [port["name"] for port in component["children"]] == [
        *("scans", "wheel_odometry", "inertia", "map"),
        *("pose", "odometry"),
    ]
    assert component["range"]["end"]["line"] == robot.find(STATE, "tags: [navigation]|")[1] - 1


def test_blocks_and_comments_can_be_folded(robot: Workspace) -> None:
    text = robot.read(CASES)
    folds = robot.client.of("foldingRange", CASES)
    assert {"startLine": 0, "endLine": 1, "kind": "comment"} in folds
    start = text[: text.index("  UC-1:")].count("\n")
    end = text[: text.index("  UC-2:")].count("\n") - 1
    assert {"startLine": start, "endLine": end} in folds


def test_symbols_of_the_workspace_are_found_by_letters(robot: Workspace) -> None:
    robot.read(STATE)
    names = [each["name"] for each in robot.client.request("workspace/symbol", {"query": "arm_state_est"})]
    assert names[0] == "robot_state.arm_state_estimator"
    assert robot.client.request("workspace/symbol", {"query": "no such thing at all"}) == []


def test_flow_is_followed_in_both_directions(robot: Workspace) -> None:
    (item,) = robot.ask("prepareCallHierarchy", ACTION, "      base_con|troller:")
    incoming = robot.client.request("callHierarchy/incomingCalls", {"item": item})
    outgoing = robot.client.request("callHierarchy/outgoingCalls", {"item": item})
    assert [each["from"]["name"] for each in incoming] == [
        "robot_action_planner.velocity_arbiter",
        "hardware.mobile_base",
    ]
    assert [each["to"]["name"] for each in outgoing] == ["robot_state.base_localisation", "hardware.mobile_base"]


def test_outputs_show_their_readers_and_topics(robot: Workspace) -> None:
    robot.read(STATE)
    line = robot.find(STATE, "          pose|: Robot pose")[1] - 1
    lenses = {each["range"]["start"]["line"]: each["command"]["title"] for each in robot.client.of("codeLens", STATE)}
    assert lenses[line] == "2 readers"
    everything = {"start": {"line": 0, "character": 0}, "end": {"line": 1000, "character": 0}}
    hints = robot.client.of("inlayHint", STATE, range=everything)
    assert {"line": line, "character": 14} in [each["position"] for each in hints if each["label"] == "/amcl_pose"]


def test_chains_show_their_bounds(robot: Workspace) -> None:
    robot.read(CHAINS)
    line = robot.find(CHAINS, "  contact_to_stop|:")[1] - 1
    lenses: dict[int, str] = {}
    while line not in lenses:  # timing follows the check; `pytest` ends who waits for ever
        robot.client.rest(0.2)
        answer = robot.client.of("codeLens", CHAINS)
        lenses = {each["range"]["start"]["line"]: each["command"]["title"] for each in answer}
    assert lenses[line].startswith("bound ")
    assert lenses[line].endswith(" ms of 60 ms")


def test_names_are_coloured_by_what_they_are(robot: Workspace) -> None:
    robot.read(STATE)
    kinds = robot.client.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"]
    data = robot.client.of("semanticTokens/full", STATE)["data"]
    words: dict[str, str] = {}
    line, character = 0, 0
    lines = robot.read(STATE).split("\n")
    for down, right, length, kind, _ in zip(*[iter(data)] * 5, strict=True):
        line, character = line + down, right + (0 if down else character)
        words[lines[line][character : character + length]] = kinds[kind]
    assert words["robot_state"] == "namespace"
    assert words["base_controller"] == words["base_localisation"] == "class"
    assert words["Robot pose"] == "type"
    assert words["pose"] == "property"
