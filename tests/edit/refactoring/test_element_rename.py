"""Renames: every name follows, every other byte stays, models are equal, and what cannot be is refused in words."""

from __future__ import annotations

import random
import re
import shutil
from pathlib import Path

import pytest

from archgen.checking.reference_index import PATH_KINDS, Element
from archgen.edit.element_edit import EditRefusedError
from archgen.edit.refactoring.element_rename import find_element, plan_rename
from archgen.edit.refactoring.judged_version import JudgedVersion, judge_edited, judge_version
from archgen.edit.refactoring.kept_names import KeptNames
from archgen.edit.refactoring.refactoring import Refactoring
from archgen.project import load_project
from tests.property_sizes import DRAWS_ANEW
from tests.running import RAMCIP, ROOT

PROJECT = """\
archgen: 1
# Who builds it.
partners: {lab: Lab, shop: Shop}
hosts: {pc: PC}
component_types:
  arm:
    inputs: {goal: {type: Goal}}
    outputs: {state: {from: joint.angle}}   # passed on
    components:
      joint:
        inputs: {target: {from: self.goal}}
        outputs: {angle: {type: "Angle"}}
groups:
  body:
    owner: lab
    components:
      left: {is: arm, inputs: {goal: {from: plan}}}
      right: {is: arm, inputs: {goal: {from: planner.plan}}}
      left.joint: {requirements: [R-1]}
      planner: {inputs: {state: {from: left}}, outputs: {plan: {type: Goal}}}
requirements: {R-1: Move}
types: {Goal: {fields: {at: Angle}}, Angle: {fields: {a: float64}}}
nodes:
  brain: {implements: 'planner', host: pc, publishes: {plan: {topic: /plan}}}
views: {some: {show: "body.planner+ owner:lab -right"}}
variants:
  one:
    without: right
    changes: {nodes: {brain: {subscribes: {state: /state}}}, groups: {body: {owner: shop}}}
"""


def read(folder: Path, text: str | bytes = PROJECT, **others: str) -> JudgedVersion:
    """Write a project, and judge it. Further files are named by their stem."""
    data = text if isinstance(text, bytes) else text.encode()
    (folder / "archgen.yaml").write_bytes(data)
    for name, other in others.items():
        (folder / f"{name}.yaml").write_text(other, encoding="utf-8")
    return judge_version(load_project(folder))


def rename(version: JudgedVersion, old: str, new: str, kept: KeptNames = KeptNames()) -> Refactoring:  # noqa: B008
    kind, name = split_kind(old)
    return plan_rename(version, find_element(version, name, kind), new, kept)


def split_kind(text: str) -> tuple[str | None, str]:
    """Give the kind and the name in `node brain`; a name alone has no kind."""
    kind, _, name = text.partition(" ")
    return (kind, name) if name else (None, kind)


def added_words(refactoring: Refactoring) -> list[str]:
    """Give the lines that are new, by file, without blanks around them."""
    lines = [line for edit in refactoring.edits for line in edit.unified_diff()]
    return [line[1:].strip() for line in lines if line.startswith("+") and not line.startswith("+++")]


@pytest.mark.parametrize(
    ("old", "new", "lines"),
    [
        (
            "planner",
            "thinker",
            [
                "right: {is: arm, inputs: {goal: {from: thinker.plan}}}",
                "thinker: {inputs: {state: {from: left}}, outputs: {plan: {type: Goal}}}",
                "brain: {implements: 'thinker', host: pc, publishes: {plan: {topic: /plan}}}",
                'views: {some: {show: "body.thinker+ owner:lab -right"}}',
            ],
        ),
        (
            "body.left.joint",  # stands in the type, and in what one instance says beside it
            "elbow",
            [
                "outputs: {state: {from: elbow.angle}}   # passed on",
                "elbow:",
                "left.elbow: {requirements: [R-1]}",
            ],
        ),
        ("type Angle", "Turn", ['outputs: {angle: {type: "Turn"}}', "types: {Goal: {fields: {at: Turn}}, Turn: {fields: {a: float64}}}"]),
        ("component_type arm", "limb", ["limb:", "left: {is: limb, inputs: {goal: {from: plan}}}", "right: {is: limb, inputs: {goal: {from: planner.plan}}}"]),
        ("partner lab", "uni", ["partners: {uni: Lab, shop: Shop}", "owner: uni", 'views: {some: {show: "body.planner+ owner:uni -right"}}']),
        ("node brain", "mind", ["mind: {implements: 'planner', host: pc, publishes: {plan: {topic: /plan}}}", "changes: {nodes: {mind: {subscribes: {state: /state}}}, groups: {body: {owner: shop}}}"]),
        ("planner.state", "arm_state", ["planner: {inputs: {arm_state: {from: left}}, outputs: {plan: {type: Goal}}}", "changes: {nodes: {brain: {subscribes: {arm_state: /state}}}, groups: {body: {owner: shop}}}"]),
        ("host pc", "board", ["hosts: {board: PC}", "brain: {implements: 'planner', host: board, publishes: {plan: {topic: /plan}}}"]),
        ("requirement R-1", "R-20", ["left.joint: {requirements: [R-20]}", "requirements: {R-20: Move}"]),
        ("body.right", "other", ["other: {is: arm, inputs: {goal: {from: planner.plan}}}", 'views: {some: {show: "body.planner+ owner:lab -other"}}', "without: other"]),
        ("variant one", "two", ["two:"]),
    ],
)  # fmt: skip
def test_all_names_follow_and_the_reverse_gives_each_byte_back(
    tmp_path: Path, old: str, new: str, lines: list[str]
) -> None:
    version = read(tmp_path)
    renamed = rename(version, old, new)
    assert added_words(renamed) == lines
    kind, _, name = old.rpartition(" ")
    edited = judge_edited(version, {edit.file: edit.new_content for edit in renamed.edits})
    new_id = new if kind else f"{name.rpartition('.')[0]}.{new}".lstrip(".")
    back = rename(edited, f"{kind or ''} {new_id}".strip(), name.rpartition(".")[2])
    assert [edit.new_content for edit in back.edits] == [edit.old_content for edit in renamed.edits]


@pytest.mark.parametrize("text", [PROJECT.replace("\n", "\r\n"), "\ufeff" + PROJECT, PROJECT.rstrip("\n")])
def test_line_ends_mark_and_end_of_file_stay(tmp_path: Path, text: str) -> None:
    (edit,) = rename(read(tmp_path, text), "planner", "thinker").edits
    assert edit.new_content.decode() == re.sub(r"\bplanner\b", "thinker", text)


SHORT = """\
archgen: 1
groups:
  a: {components: {one: {outputs: {far: T}}, two: {outputs: {near: T}}}}
  b: {components: {one_b: {inputs: {i: {from: far}}}}}
types: {T: {message: std_msgs/msg/Empty}}
"""


def test_a_reference_that_would_mean_several_is_lengthened_and_told(tmp_path: Path) -> None:
    renamed = rename(read(tmp_path, SHORT), "near", "far")
    assert added_words(renamed) == [
        "a: {components: {one: {outputs: {far: T}}, two: {outputs: {far: T}}}}",
        "b: {components: {one_b: {inputs: {i: {from: one.far}}}}}",
    ]
    (note,) = (each for each in renamed.notes if "shorter" in each)
    assert note == "archgen.yaml:4:47: `far` is `one.far` now: the shorter path would mean something else"


def test_a_reference_inside_of_a_type_is_lengthened_once_for_all_instances(tmp_path: Path) -> None:
    text = """\
archgen: 1
component_types:
  arm:
    outputs: {state: {from: angle}}
    components:
      joint: {outputs: {angle: {type: T}}}
      wrist: {outputs: {turn: {type: T}}}
groups: {body: {components: {left: {is: arm}, right: {is: arm}}}}
types: {T: {message: std_msgs/msg/Empty}}
"""
    assert added_words(rename(read(tmp_path, text), "arm.wrist.turn", "angle")) == [
        "outputs: {state: {from: joint.angle}}",
        "wrist: {outputs: {angle: {type: T}}}",
    ]


def test_what_follows_on_the_wire_is_told_or_kept(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: robot}
groups:
  a:
    components:
      one: {outputs: {far: Long word}}
      two: {inputs: {i: {from: far}}}
nodes:
  first: {implements: one}
  second: {implements: two}
types: {Long word: {fields: {a: float64}}}
"""
    version = read(tmp_path, text)
    assert rename(version, "a.one", "uno").notes == (
        "the title `One` is `Uno` now (--keep-title keeps it)",
        "on the wire: the topic `/a/one/far` is `/a/uno/far` now",
    )
    assert rename(version, "node first", "prime").notes[1:] == ("on the wire: the node `/first` is `/prime` now",)
    assert rename(version, "type Long word", "Word").notes == (
        "on the wire: the message `robot_msgs/msg/LongWord` is `robot_msgs/msg/Word` now",
    )
    kept = rename(version, "a.one", "uno", KeptNames(topics=True, title=True))
    assert kept.notes == ()
    assert added_words(kept) == [
        "uno: {outputs: {far: Long word}, title: One}",
        "first: {implements: uno, publishes: {far: {topic: /a/one/far}}}",
    ]
    assert "name: first" in added_words(rename(version, "node first", "prime", KeptNames(topics=True)))[0]
    (line,) = added_words(rename(version, "type Long word", "Word", KeptNames(message=True)))[-1:]
    assert line == "types: {Word: {fields: {a: float64}, message: robot_msgs/msg/LongWord}}"


def test_two_topics_never_become_one(tmp_path: Path) -> None:
    text = SHORT + "nodes: {m: {implements: a.one}, n: {implements: a.two, publishes: {near: {topic: /a/uno/far}}}}\n"
    with pytest.raises(EditRefusedError, match="more than names would change"):
        rename(read(tmp_path, text), "a.one", "uno")


def test_how_to_see_what_was_signed_under_another_name_is_told_as_a_command(tmp_path: Path) -> None:
    revision = "14fa8181685d006e3f0ad642f6d748ceec0f02e0"
    agreement = f"{{rules: 2, tag: signed/lab-shop/2026-11-29, revision: {revision}, terms: a1b2c3, by: {{lab: 'A, 2026-11-29'}}, versions: {{lab: {{body.planner.plan: 3fa9c1}}}}}}"
    version = read(tmp_path, f"{PROJECT}agreements: {{lab-shop: {{signed: {agreement}}}}}\n")
    words = "`archgen interfaces --between lab shop --signed signed/lab-shop/2026-11-29` says what is called otherwise since"
    for named, name in (
        ("planner.plan", "route"),
        ("body", "trunk"),
        ("type Angle", "Bend"),
    ):
        notes = [each for each in rename(version, named, name).notes if "signed" in each]
        assert notes == [f"what was signed is not edited: {words}"], named
    for named, name in (("view some", "few"), ("host pc", "computer"), ("body.left", "port_side"), ("R-1", "R-2")):
        assert not [each for each in rename(version, named, name).notes if "signed" in each], named


def test_a_partner_that_has_an_agreement_keeps_its_name(tmp_path: Path) -> None:
    agreed = PROJECT + "agreements: {lab-shop: {terms: {late: the robot stops}}}\n"
    with pytest.raises(EditRefusedError, match=r"archgen\.yaml:30:14 is an agreement under the ids of both") as refused:
        rename(read(tmp_path, agreed), "partner shop", "seller")
    assert refused.value.by_hand == "take it away, rename, and write it again as `lab-seller`"
    with pytest.raises(EditRefusedError) as refused:
        rename(
            read(tmp_path, agreed.replace("terms: {late: the robot stops}", "signed: {rules: 2}")), "partner lab", "a"
        )
    assert (
        refused.value.by_hand == "what was signed names them: take the agreement away, rename, and let both sign again"
    )


def test_chapters_follow_and_programs_are_named(tmp_path: Path) -> None:
    (tmp_path / "text.md").write_text(
        "# Text\n\nThe `a.one` sends `far`, see [it](#component:a.one); `one more` and one stay.\n", encoding="utf-8"
    )
    (tmp_path / "passes").mkdir()
    (tmp_path / "passes" / "own.py").write_text("# no one\n", encoding="utf-8")
    version = read(tmp_path, SHORT + "report: {chapters: [text.md]}\n")
    renamed = rename(version, "a.one", "uno")
    assert "The `a.uno` sends `far`, see [it](#component:a.uno); `one more` and one stay." in added_words(renamed)
    assert "programs are not edited, and hold the word: passes/own.py:1" in renamed.notes
    kept = rename(version, "a.one", "uno", KeptNames(chapters=True))
    assert [edit.file for edit in kept.edits] == ["archgen.yaml"]


@pytest.mark.parametrize(
    ("old", "new", "message", "by_hand"),
    [
        ("two", "one", "the name is taken: archgen.yaml:3:20 declares the component `a.one`", "choose another one"),
        ("two", "two", "`a.two` is called so already", ""),
        ("two", "Two", "`Two` cannot be a component's id", "write `two`"),
        ("twoo", "x", "nothing is named `twoo`", "did you mean `two`?"),
        ("two", "x}\nnodes: {y: 1", "the new name has '}' in it", "choose a plain one"),
        ("two", "\n", "the new name has", "choose a plain one"),
        ("two", " ", "the new name is empty or too long", "choose a plain one"),
        ("two", "x" * 1000, "the new name is empty or too long", "choose a plain one"),
        ("two", "\U0001f600", "`\U0001f600` cannot be a component's id", ""),
        ("", "x", "nothing is named ``", ""),
        ("host two", "x", "no host is named `two`", "`archgen list` shows what there is"),
        ("a", "c.d", "`c.d` cannot be an id", "an id is"),
        (
            "two",
            "b.x",
            "`a.two` does not stand in `b`",
            "write the name alone, `x`; `archgen move` gives it another place",
        ),
        ("two", "x", "more than names would change: what `a.t*` selects in the view `v`", "choose another name"),
    ],
)
def test_what_cannot_be_is_refused_with_what_to_do(
    tmp_path: Path, old: str, new: str, message: str, by_hand: str
) -> None:
    version = read(tmp_path, SHORT + 'views: {v: {show: "a.t*"}}\n')
    with pytest.raises(EditRefusedError) as refused:
        rename(version, old, new)
    assert message in refused.value.message
    assert by_hand in refused.value.by_hand


def test_the_path_that_it_has_may_stand_before_the_new_name(tmp_path: Path) -> None:
    version = read(tmp_path, SHORT)
    for new_name in ("uno", "a.uno"):
        assert added_words(rename(version, "a.one", new_name)) == added_words(rename(version, "one", "uno"))


def test_a_word_that_means_two_things_is_asked_for(tmp_path: Path) -> None:
    version = read(tmp_path, SHORT + "nodes: {one: {implements: a.one}}\n")
    with pytest.raises(EditRefusedError, match=r"`one` can mean component `a.one`, node `one`"):
        rename(version, "one", "x")
    assert added_words(rename(version, "node one", "x"))[0] == "nodes: {x: {implements: a.one}}"


def test_what_a_short_form_makes_is_refused(tmp_path: Path) -> None:
    text = (
        "archgen: 1\ngroups: {g: {components: {c: {outputs: [Laser pose]}}}}\ntypes: {Laser pose: {message: a/msg/B}}\n"
    )
    with pytest.raises(EditRefusedError, match=r"`g.c.laser_pose` follows from a short form"):
        rename(read(tmp_path, text), "laser_pose", "x")


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    version = read(tmp_path, SHORT + 'sources: ["*.yaml"]\n', other="groups: {a: {\n")
    with pytest.raises(EditRefusedError, match="cannot be read") as refused:
        rename(version, "a.one", "x")
    assert [each.span.file for each in refused.value.errors] == ["other.yaml"]


def test_an_element_of_a_library_is_edited_there(tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / "types.yaml").write_text(
        "component_types: {eye: {outputs: {seen: {type: T}}}}\n", encoding="utf-8"
    )
    text = SHORT + "libraries: {shared: shared}\n"
    version = read(tmp_path, text.replace("one_b: {", "eye: {is: shared.eye}, one_b: {"))
    with pytest.raises(EditRefusedError, match="in a library") as refused:
        rename(version, "component_type shared.eye", "ear")
    assert refused.value.by_hand.startswith("edit it in the library's files")
    assert added_words(rename(version, "b.eye", "ear"))[0].startswith("b: {components: {ear: {is: shared.eye}")


def test_a_library_is_renamed_whatever_its_types_hold(tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    types = "motor: {inputs: {target: {type: T}}, outputs: {state: {type: T}}}\n"
    hand = "hand: {inputs: {grip: {type: T}}, outputs: {state: {from: thumb.state}}, components: {thumb: {is: motor, inputs: {target: self.grip}}}}\n"
    (tmp_path / "shared" / "parts.yaml").write_text(f"component_types:\n  {types}  {hand}", encoding="utf-8")
    text = SHORT + "libraries: {shared: shared}\n"
    version = read(tmp_path, text.replace("one_b: {", "hand: {is: shared.hand}, one_b: {"))
    renamed = rename(version, "library shared", "parts")
    assert [each for each in added_words(renamed) if "parts" in each] == added_words(renamed)
    assert any("hand: {is: parts.hand}" in each for each in added_words(renamed))


def test_a_file_that_is_read_by_the_id_of_a_partner_is_named_first(tmp_path: Path) -> None:
    (tmp_path / "review").mkdir()
    (tmp_path / "review" / "lab.yaml").write_text(
        "review: {accepted: {body.left: no longer there}}\n", encoding="utf-8"
    )
    with pytest.raises(EditRefusedError, match=r"review/lab\.yaml is read by the id of the partner") as refused:
        rename(read(tmp_path), "partner lab", "uni")
    assert refused.value.by_hand == "`git mv review/lab.yaml review/uni.yaml` first"
    # What a partner accepted follows the element.
    assert "review: {accepted: {body.lefty: no longer there}}" in added_words(
        rename(read(tmp_path), "body.left", "lefty")
    )


def test_a_file_behind_a_link_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "more.yaml").write_text("nodes: {one: {implements: a.one}}\n", encoding="utf-8")
    robot = tmp_path / "robot"
    robot.mkdir()
    (robot / "more.yaml").symlink_to(tmp_path / "elsewhere" / "more.yaml")
    with pytest.raises(EditRefusedError, match="cannot be read") as refused:
        rename(read(robot, SHORT + "sources: [more.yaml]\n"), "a.one", "x")
    assert "link" in refused.value.errors[0].message


ALL_KINDS = """\
archgen: 1
partners: {lab: Lab}
properties: {sil: {type: integer, of: [component]}}
use_cases: {UC-1: {actors: {user: User}, steps: [{from: user, to: eye, say: waves}]}}
requirements: {R-1: {title: See, verified_by: [UC-1, look], use_cases: [UC-1]}, R-2: {title: See more, parent: R-1}}
groups:
  head:
    components:
      eye:
        owner: lab
        properties: {sil: 2}
        requirements: [R-1]
        outputs: {image: {type: Image, frame: optic}}
        frames: {optic: {parent: base}}
      brain: {inputs: {image: {from: image}}, timing: {uses: {bus: 1 ms}}}
frames: {base: {}}
hosts: {pc: PC, board: Board}
containers: {box: {host: pc}}
resources: {bus: {host: pc}}
links: {wire: {connects: [pc, board], bandwidth: 1 Mbit/s}}
nodes:
  see: {implements: eye, container: box}
  think: {implements: brain, host: pc}
chains: {look: {through: [see, think], deadline: 1 s}}
views: {front: {show: "property:sil>=2 host:pc use_case:UC-1 requirement:R-1 -node:think"}}
policies: {safe: {require: {of: brain, inputs_from: owner:lab, guarded_by: sil}}}
types: {Image: {message: sensor_msgs/msg/Image}}
variants:
  indoor: {drop: [links.wire, groups.head.components.eye.properties], changes: {nodes: {see: {host: pc}}}}
  night: {of: indoor}
"""


@pytest.mark.parametrize(
    ("old", "new", "count"),
    [
        ("partner lab", "uni", 3),
        ("property_declaration sil", "asil", 4),
        ("use_case UC-1", "UC-7", 4),
        ("actor UC-1.user", "guest", 2),
        ("requirement R-1", "R-7", 4),
        ("group head", "face", 2),
        ("component head.eye", "camera", 4),
        ("output head.eye.image", "picture", 2),
        ("input head.brain.image", "picture", 1),
        ("frame optic", "lens", 2),
        ("frame base", "body", 2),
        ("host pc", "computer", 7),
        ("container box", "process", 2),
        ("resource bus", "rail", 2),
        ("link wire", "cable", 2),
        ("node think", "decide", 3),
        ("node see", "watch", 3),
        ("chain look", "glance", 2),
        ("view front", "ahead", 1),
        ("policy safe", "safer", 1),
        ("type Image", "Picture", 2),
        ("variant indoor", "inside", 2),
    ],
)
def test_every_kind_is_renamed_and_comes_back(tmp_path: Path, old: str, new: str, count: int) -> None:
    version = read(tmp_path, ALL_KINDS)
    assert not version.project.structural_errors
    kind, name = split_kind(old)
    element = find_element(version, name, kind)
    (edit,) = plan_rename(version, element, new).edits
    text = edit.new_content.decode()
    word = re.compile(rf"(?<![\w-]){re.escape(new)}(?![\w-])")
    assert len(word.findall(text)) == count
    back = plan_rename(
        judge_edited(version, {edit.file: edit.new_content}), _renamed(element, new), name.rpartition(".")[2]
    )
    assert [each.new_content for each in back.edits] == [ALL_KINDS.encode()]


def _renamed(element: Element, new: str) -> Element:
    outer, dot, _ = element[1].rpartition(".") if element[0] in PATH_KINDS else ("", "", "")
    return element[0], f"{outer}{dot}{new}"


EXAMPLES = sorted(file.parent for file in ROOT.glob("examples/**/archgen.yaml") if "plugin" not in file.parts)


def draw_renames(folder: Path, count: int, seed: int) -> list[str]:
    """Try random renames there and back; return what is wrong: bytes that do not come back, other exceptions."""
    chance = random.Random(seed)  # noqa: S311
    version = judge_version(load_project(folder))
    declared = [each for each in version.index.names if each.is_declaration]
    elements = sorted({(each.kind, each.id) for each in declared})
    ends = sorted({each.id.rpartition(".")[2] for each in declared})
    wrong = []
    for _ in range(count):
        element = chance.choice(elements)
        new_name = chance.choice([*ends, *["renamed_thing"] * len(ends)])
        try:
            renamed = plan_rename(version, element, new_name)
            wrong += _go_back(version, renamed, element)
        except EditRefusedError as refused:
            wrong += [] if refused.message else [f"{element} is refused without a reason"]
    return wrong


def _go_back(version: JudgedVersion, renamed: Refactoring, element: Element) -> list[str]:
    if any("shorter" in note for note in renamed.notes):
        return []  # what was lengthened stays longer, and `archgen undo` is the way back
    edited = judge_edited(version, {edit.file: edit.new_content for edit in renamed.edits})
    old_name = element[1].rpartition(".")[2] if element[0] in PATH_KINDS else element[1]
    back = plan_rename(edited, renamed.renamed.pairs[element], old_name)
    contents = {edit.file: edit.new_content for edit in back.edits}
    same = all(contents.get(edit.file) == edit.old_content for edit in renamed.edits)
    return [] if same else [f"{element} does not come back"]


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda folder: folder.name)
def test_random_renames_come_back(folder: Path) -> None:
    assert draw_renames(folder, 4, 7) == []


@pytest.mark.slow
@pytest.mark.hypothesis
@pytest.mark.parametrize("folder", [*EXAMPLES, RAMCIP], ids=lambda folder: folder.name)
def test_more_random_renames_come_back(folder: Path) -> None:
    assert draw_renames(folder, 40 if DRAWS_ANEW else 16, 11) == []


@pytest.mark.slow
def test_the_project_on_the_disk_is_not_touched_by_planning(tmp_path: Path) -> None:
    shutil.copytree(RAMCIP, tmp_path / "robot", ignore=shutil.ignore_patterns("archgen-out"))
    before = {file: file.read_bytes() for file in (tmp_path / "robot").rglob("*") if file.is_file()}
    rename(judge_version(load_project(tmp_path / "robot")), "group human_state", "humans")
    assert {file: file.read_bytes() for file in (tmp_path / "robot").rglob("*") if file.is_file()} == before
