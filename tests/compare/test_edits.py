"""One edit is one item: what is told as one sentence, and what must not hide in it."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from archgen.compare.edits import list_edits
from archgen.compare.reshaping import find_reshapings, truncate_confidence
from tests.compare.conftest import Compared

ROBOT = """\
partners: {vega: Vega, orsa: Orsa}
requirements: {R-1: Stops for people, R-2: Picks ripe fruit, R-3: Follows the rows}
groups:
  eyes:
    owner: vega
    components:
      left:
        {functionality: Sees the trees on the left, outputs: {image: Image}}
      right:
        {functionality: Sees the trees on the right, outputs: {image: Image}}
      finder:
        functionality: Finds people and rows in both pictures
        requirements: [R-1, R-3]
        timing: {rate: 10 Hz, wcet: 20 ms}
        inputs: {left: left.image, right: right.image}
        outputs: {people: {type: People, description: Distances in metres}, rows: Rows}
  legs:
    owner: orsa
    components:
      driver:
        requirements: [R-3]
        timing: {rate: 50 Hz, wcet: 1 ms}
        inputs: {rows: finder.rows, people: finder.people}
        outputs: {speed: Speed}
types: {People: geometry_msgs/msg/PoseArray, Rows: {message: nav_msgs/msg/Path}, Image: sensor_msgs/msg/Image, Speed: geometry_msgs/msg/Twist}
hosts: {pc: {cores: 4}, box: {cores: 4}}
nodes:
  left_driver: {implements: left, host: pc}
  right_driver: {implements: right, host: pc}
  finder: {implements: finder, host: pc, publishes: {people: /people, rows: /rows}}
  driver: {implements: driver, host: pc}
"""
PLAIN_LEFT = """\
      left:
        {functionality: Sees the trees on the left, outputs: {image: Image}}
"""
FINDER = ROBOT[ROBOT.index("      finder:\n") : ROBOT.index("  legs:")]
PEOPLE = """\
      people_finder:
        functionality: Finds people in both pictures
        requirements: [R-1]
        timing: {rate: 10 Hz, wcet: 10 ms}
        inputs: {left: left.image, right: right.image}
        outputs: {people: {type: People, description: Distances in metres}}
"""
ROWS = """\
      row_finder:
        functionality: Finds rows in both pictures
        requirements: [R-3]
        timing: {rate: 10 Hz, wcet: 10 ms}
        inputs: {left: left.image, right: right.image}
        outputs: {rows: Rows}
"""
SPLIT = (
    ROBOT.replace(FINDER, PEOPLE + ROWS)
    .replace("finder.rows", "row_finder.rows")
    .replace("finder.people", "people_finder.people")
    .replace(
        "  finder: {implements: finder, host: pc, publishes: {people: /people, rows: /rows}}",
        "  people_finder: {implements: people_finder, host: pc, publishes: {people: /people}}\n"
        "  row_finder: {implements: row_finder, host: pc, publishes: {rows: /rows}}",
    )
)


def edited(text: str, *changes: tuple[str, str]) -> str:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


def told_edits(compared: Compared, before: str, after: str) -> list[str]:
    return [f"{edit.kind} {edit.text}" for edit in list_edits(compared(before, after))]


SPLIT_TEXT = "split component `eyes.finder` is split into `eyes.people_finder` (output `people`) and `eyes.row_finder` (output `rows`)"
MERGED_TEXT = "merged components `eyes.people_finder` and `eyes.row_finder` are merged into `eyes.finder`"


def test_a_split_and_a_merger_are_one_item_each(compared: Compared) -> None:
    assert told_edits(compared, ROBOT, SPLIT) == [SPLIT_TEXT]
    assert told_edits(compared, SPLIT, ROBOT) == [MERGED_TEXT]


@pytest.mark.parametrize(
    ("changes", "rest"),
    [
        ([("rate: 10 Hz, wcet: 10 ms}\n        inputs: {left: left.image, right: right.image}\n        outputs: {rows", "rate: 5 Hz, wcet: 10 ms}\n        inputs: {left: left.image, right: right.image}\n        outputs: {rows")], "`eyes.row_finder.rows` has the rate `5 Hz` instead of `10 Hz`"),
        ([("Distances in metres", "Distances in millimetres")], "the description of `eyes.people_finder.people` is another: `Distances in metres` → `Distances in millimetres`"),
        ([("outputs: {rows: Rows}", "outputs: {rows: Rows, dust: Dust}")], "`eyes.row_finder.dust` is new"),
        ([("right: right.image}\n        outputs: {rows", "right: right.image, speed: driver.speed}\n        outputs: {rows")], "they also read `legs.driver.speed`"),
        ([("left: left.image, right: right.image", "left: left.image")], "they no longer read `eyes.right.image`"),
    ],
)  # fmt: skip
def test_nothing_hides_in_a_split(compared: Compared, changes: list[tuple[str, str]], rest: str) -> None:
    (edit, *_) = told_edits(compared, ROBOT, edited(SPLIT, *changes))
    assert edit.startswith("split ")
    assert edit.endswith(f"; {rest}")


@pytest.mark.parametrize(
    ("old_way", "new_way", "is_told"),
    [
        ("[left, finder, driver]", "[left, row_finder, driver]", False),
        ("[left, finder.rows, driver]", "[left, row_finder.rows, driver]", False),
        ("[left, finder, driver]", "[left, driver]", False),
        ("[left, finder, driver]", "[row_finder, driver]", True),
        ("[left, finder, driver]", "[right, row_finder, driver]", True),
    ],
)
def test_a_chain_that_follows_a_split_is_a_part_of_it(
    compared: Compared, old_way: str, new_way: str, *, is_told: bool
) -> None:
    before, after = (
        f"{text}chains: {{see: {{through: {way}}}}}\n" for text, way in ((ROBOT, old_way), (SPLIT, new_way))
    )
    assert [edit.kind for edit in list_edits(compared(before, after))] == ["split", *(["changed"] if is_told else [])]


def test_a_part_that_changes_hands_says_so(compared: Compared) -> None:
    handed_over = edited(SPLIT, (ROWS, ""), ("      driver:\n", f"{ROWS}      driver:\n"))
    handed_over = edited(handed_over, ("left: left.image", "left: eyes.left.image"))
    (edit, *_) = told_edits(compared, ROBOT, handed_over)
    assert edit.startswith("split component `eyes.finder` is split into ")
    assert "`legs.row_finder` belongs to Orsa instead of Vega" in edit


def test_an_output_that_a_split_forgets_is_gone(compared: Compared) -> None:
    three = edited(ROBOT, ("rows: Rows}", "rows: Rows, dust: Dust}"))
    (edit, *_) = told_edits(compared, three, SPLIT)
    assert edit == f"{SPLIT_TEXT}; `eyes.finder.dust` is gone"


def test_a_part_on_another_computer_is_an_item_of_its_own(compared: Compared) -> None:
    moved = edited(SPLIT, ("implements: row_finder, host: pc", "implements: row_finder, host: box"))
    assert any(text.startswith("added node `row_finder` is added") for text in told_edits(compared, ROBOT, moved))


def test_a_part_is_split_off(compared: Compared) -> None:
    after = edited(
        ROBOT,
        (", rows: Rows}", "}"),
        ("  legs:", f"{ROWS}  legs:"),
        ("rows: finder.rows", "rows: row_finder.rows"),
        (", rows: /rows}}", "}}\n  row_finder: {implements: row_finder, host: pc, publishes: {rows: /rows}}"),
    )
    edits = told_edits(compared, ROBOT, after)
    assert edits == ["split component `eyes.finder` is split: `eyes.row_finder` takes over the output `rows`"]
    renamed = edited(after, ("{rows: Rows}", "{lines: Lines}"), ("row_finder.rows", "row_finder.lines"), ("{rows: /rows}", "{lines: /rows}"), ("Rows: {", "Lines: {"))  # fmt: skip
    assert any("takes over the output `rows` as `lines`" in text for text in told_edits(compared, ROBOT, renamed))


@pytest.mark.parametrize(
    "after",
    [
        edited(SPLIT, ("rows: Rows}", "rows: Dust}"), ("publishes: {rows: /rows}", "package: p"), ("rows: row_finder.rows, ", "")),
        edited(ROBOT, (FINDER, ""), ("rows: finder.rows, people: finder.people", "image: left.image"), ("  finder: {implements: finder, host: pc, publishes: {people: /people, rows: /rows}}\n", "")),
        edited(ROBOT, ("  legs:", "      other: {inputs: {image: left.image}, outputs: {fruit: Fruit}}\n  legs:")),
        edited(ROBOT, ("finder", "seeker")),
    ],
)  # fmt: skip
def test_what_is_no_split_is_none(compared: Compared, after: str) -> None:
    assert {edit.kind for edit in list_edits(compared(ROBOT, after))}.isdisjoint({"split", "merged", "copied"})


def test_a_copy_names_its_original(compared: Compared) -> None:
    copy = "      rear:\n        {functionality: Sees the trees behind, outputs: {image: Image}}\n      finder:\n"
    (edit,) = told_edits(compared, ROBOT, edited(ROBOT, ("      finder:\n", copy)))
    assert edit == (
        "copied component `eyes.rear` is added with 1 output, a copy of `eyes.left` (recognised with 72 % confidence)"
    )


def test_ids_that_were_exchanged(compared: Compared) -> None:
    exchanged = ROBOT
    for old, new in (("left", "LEFT"), ("right", "left"), ("LEFT", "right")):
        for place in ("      {}:\n", "{}.image", "implements: {}"):
            exchanged = exchanged.replace(place.format(old), place.format(new))
    (edit,) = list_edits(compared(ROBOT, exchanged))
    assert edit.text.partition("; ")[0] == "components `eyes.left` and `eyes.right` have exchanged their ids"
    assert edit.broken_partners == ()


def test_requirements_with_other_numbers_are_one_item(compared: Compared) -> None:
    after = edited(ROBOT, ("R-3", "R-13"), ("R-2", "R-12"), ("R-1:", "R-11:"), ("[R-1,", "[R-11,"))
    assert told_edits(compared, ROBOT, after) == [
        "renamed 3 requirements got other ids: `R-1` → `R-11`, `R-2` → `R-12` and `R-3` → `R-13`"
    ]
    shifted = edited(ROBOT, ("R-3", "R-4"), ("R-2", "R-3"), ("R-1", "R-2"))
    assert told_edits(compared, ROBOT, shifted) == [
        "renamed 3 requirements got other ids: `R-1` → `R-2`, `R-2` → `R-3` and `R-3` → `R-4`"
    ]


def test_a_group_with_another_id_and_title_is_one_item(compared: Compared) -> None:
    after = edited(ROBOT, ("  eyes:\n", "  seeing:\n    title: All that sees\n"))
    (edit,) = told_edits(compared, ROBOT, after)
    assert edit.startswith("renamed group `eyes` is called `seeing` now, title `Eyes` → `All that sees`; ")


def test_a_component_that_moves_to_another_owner_is_one_item(compared: Compared) -> None:
    after = edited(ROBOT, (PLAIN_LEFT, ""), ("      driver:\n", f"{PLAIN_LEFT}      driver:\n"))
    assert told_edits(compared, ROBOT, after)[0].partition("; ")[0] == (
        "moved component `eyes.left` moved to the group `legs`, and belongs to Orsa now, not to Vega"
    )


def test_a_group_that_goes_up_in_another_one_is_one_item(compared: Compared) -> None:
    driver = ROBOT[ROBOT.index("      driver:\n") : ROBOT.index("types:")]
    after = edited(ROBOT, (driver, ""), ("  legs:\n    owner: orsa\n    components:\n", driver))
    assert told_edits(compared, ROBOT, after) == [
        (
            "merged group `legs` is merged into `eyes`, with `eyes.driver`; it belongs to Vega now, not to Orsa; "
            "`/legs/driver/speed` becomes `/eyes/driver/speed`"
        )
    ]


def test_topics_that_follow_a_namespace_are_one_item(compared: Compared) -> None:
    before = edited(ROBOT, ("people: /people, rows: /rows", "people: people, rows: rows"))
    after = edited(before, ("finder: {implements: finder,", "finder: {implements: finder, namespace: /safe,"))
    edits = list_edits(compared(before, after))
    assert [edit.text for edit in edits] == [
        "node `finder`: namespace set to `/safe`; its names follow: `/people` → `/safe/people` and `/rows` → `/safe/rows`"
    ]
    assert edits[0].broken_partners == ("orsa",)


def test_a_field_with_its_unit_is_one_item(compared: Compared) -> None:
    before = "ros: {definitions: {m_msgs/msg/M: float32 x}}\ntypes: {T: m_msgs/msg/M}\n"
    after = before.replace("float32 x", '"float32 x\\nfloat32 y # m, to the left"')
    assert told_edits(compared, before, after) == [
        "changed message `m_msgs/msg/M`: fields `float32 y` added; what is said of `y` set to `m, to the left`; it carries `T`"
    ]


@pytest.mark.parametrize(
    ("new_line", "text"),
    [
        ("int8 a\\nfloat32 height # m, upwards", "`altitude` is called `height` now"),
        (
            "int8 a\\nfloat32 height # mm, upwards",
            (
                "`altitude` is called `height` now; what is said of `altitude` no longer given (it was `m, upwards`) and "
                "what is said of `height` set to `mm, upwards`"
            ),
        ),
    ],
)
def test_what_is_said_of_a_renamed_field_is_told_if_it_changed(compared: Compared, new_line: str, text: str) -> None:
    before = 'ros: {definitions: {m_msgs/msg/M: "int8 a\\nfloat32 altitude # m, upwards"}}\ntypes: {T: m_msgs/msg/M}\n'
    after = edited(before, ("int8 a\\nfloat32 altitude # m, upwards", new_line))
    assert told_edits(compared, before, after) == [f"changed message `m_msgs/msg/M`: {text}; it carries `T`"]


def test_figures_of_one_element_are_one_item(compared: Compared) -> None:
    after = edited(ROBOT, ("timing: {rate: 50 Hz,", "timing: {behaviour: periodic, rate: 5 Hz, jitter: 2 ms,"))
    (edit,) = list_edits(compared(ROBOT, after))
    assert edit.text == "`legs.driver`: jitter set to `2 ms` and rate `50 Hz` → `5 Hz`"
    assert [change.key for change in edit.changes] == ["timing.jitter", "timing.rate"]


def test_each_change_is_in_one_edit(compared: Compared) -> None:
    comparison = compared(ROBOT, edited(SPLIT, ("R-2", "R-9"), ("50 Hz", "5 Hz")))
    changes = [change for edit in list_edits(comparison) for change in edit.changes]
    assert sorted(map(id, changes)) == sorted(map(id, comparison.changes))
    assert _component_ids(find_reshapings(comparison)) == [["eyes.people_finder", "eyes.row_finder"]]


def _component_ids(reshapings: Iterable[object]) -> list[list[str]]:
    return [sorted(reshaping.component_ids) for reshaping in reshapings]  # type: ignore[attr-defined]


def test_a_confidence_is_never_certain() -> None:
    assert (truncate_confidence(1.0), truncate_confidence(0.678)) == (0.99, 0.67)


def test_a_part_of_a_type_that_is_called_otherwise_is_one_edit_with_all_that_follows(compared: Compared) -> None:
    before = """\
types: {T: std_msgs/msg/String}
component_types:
  motor: {outputs: {x: T}, timing: {rate: 10 Hz}, node: {package: p, executable: e}}
  rig: {components: {m: {is: motor}}, outputs: {x: {from: m.x}}}
groups: {g: {components: {a: {is: rig}, b: {is: rig}, c: {is: rig}}}, h: {components: {r: {inputs: {x: [a.x, b.x, c.x]}}}}}
"""
    after = before.replace("{m: {is", "{wheel: {is").replace("m.x", "wheel.x")
    (edit,) = list_edits(compared(before, after))
    assert edit.text == (
        "component type `rig`: component `m` is called `wheel` now; in 3 instances: `g.a`, `g.b` and `g.c`, "
        "whose names follow (recognised with 73 % confidence)"
    )
    assert len(edit.changes) > 3
