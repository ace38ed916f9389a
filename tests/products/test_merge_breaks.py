"""What branches break only together: each is harmless by itself, and whichever is merged second is not."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import resources
from archgen.merge.branch_merge import preview_merges
from archgen.merge.branch_results import BranchMerge
from archgen.merge.merge_sentences import describe_conflict, describe_merge, format_merges_json
from archgen.products.merge_breaks import BRANCH_JUDGES
from tests import repositories

READER = ("outputs: {stop: Stop}", "inputs: {profile: sonar.profile}, outputs: {stop: Stop}")
FILES = {
    "archgen.yaml": """\
archgen: 1
project: {id: hull}
sources: ['groups/*.yaml']
partners: {norsk: {title: Norsk}, aegir: {title: Aegir}}
hosts: {pc: {cores: 1}}
review: {breaking: {wire: error, promise: error, meaning: error, source: note}}
types: {Profile: {fields: {ranges: {type: "float32[]", comment: Ranges in m}}}}
""",
    "groups/norsk.yaml": """\
groups:
  sense:
    owner: norsk
    components:
      sonar: {functionality: Sees., outputs: {profile: {type: Profile, promise: {rate: 5 Hz}}, raw: {type: Profile}}}
      log: {functionality: Logs., inputs: {profile: sonar.profile}}
nodes:
  sonar: {implements: sonar, host: pc, timing: {rate: 50 Hz, wcet: 1 ms}}
  log: {implements: log, host: pc, timing: {rate: 50 Hz, wcet: 1 ms}}
""",
    "groups/aegir.yaml": """\
groups:
  safe:
    owner: aegir
    components:
      guard: {functionality: Guards., inputs: {raw: sonar.raw}, outputs: {stop: Stop}}
nodes:
  guard: {implements: guard, host: pc, timing: {rate: 50 Hz, wcet: 1 ms}}
""",
}
Edits = dict[str, tuple[str, str]]
UNITS: Edits = {"archgen.yaml": ("Ranges in m}", "Ranges in mm}")}
SLOW: Edits = {"groups/norsk.yaml": ("promise: {rate: 5 Hz}", "promise: {rate: 1 Hz}")}
NEW_READER: Edits = {
    "groups/aegir.yaml": ("inputs: {raw: sonar.raw}", "inputs: {profile: sonar.profile, raw: sonar.raw}")
}
WORDS: Edits = {"groups/aegir.yaml": ("Guards.", "Guards and stops.")}


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    # Nothing reads the type of another partner yet.
    files = dict(FILES)
    files["groups/aegir.yaml"] = files["groups/aegir.yaml"].replace("inputs: {raw: sonar.raw}, ", "")
    return repositories.repository(tmp_path / "robot", files)


def branch(folder: Path, name: str, edits: Edits, start: str = "main") -> None:
    repositories.git(folder, "checkout", "-q", "-b", name, start)
    texts = {file: (folder / file).read_text() for file in edits}
    assert all(old in texts[file] for file, (old, _) in edits.items())
    repositories.commit(folder, {file: texts[file].replace(old, new) for file, (old, new) in edits.items()})
    repositories.git(folder, "checkout", "-q", "main")


def merge(folder: Path, *branches: str) -> list[BranchMerge]:
    return list(preview_merges(folder, "main", branches, BRANCH_JUDGES))


def say(folder: Path, *branches: str) -> list[str]:
    return [f"{' + '.join(each.branches)}: {describe_merge(each, 'main')}" for each in merge(folder, *branches)]


READS: Edits = {"groups/aegir.yaml": READER}


@pytest.mark.parametrize(("edits", "reason"), [(UNITS, "`Ranges in mm` instead of"), (SLOW, "1 Hz instead of 5 Hz")])
def test_what_one_branch_changes_under_the_new_reader_of_the_other_one_comes_first(
    robot: Path, edits: Edits, reason: str
) -> None:
    branch(robot, "reader", READS)
    branch(robot, "change", edits)
    assert say(robot, "reader", "change") == [
        "reader: merges",
        "change: merges",
        "reader + change: first change, then reader, whose author has to look",
    ]
    # The same whichever is named first.
    assert say(robot, "change", "reader")[2] == "change + reader: first change, then reader, whose author has to look"
    *_, pair = merge(robot, "reader", "change")
    assert pair.order == (("change",), ("reader",))
    (finding,) = pair.findings
    assert finding.severity == "error"
    assert "breaks Aegir" in finding.message
    assert reason in finding.message


def test_what_came_to_the_main_line_meanwhile_is_held_against_a_branch(robot: Path) -> None:
    branch(robot, "reader", READS)
    branch(robot, "units", UNITS)
    repositories.git(robot, "merge", "-q", "units")
    assert say(robot, "reader") == ["reader: breaks a partner together with what came to main since it left"]
    repositories.git(robot, "checkout", "-q", "reader")
    repositories.git(robot, "merge", "-q", "--no-edit", "main")
    assert say(robot, "reader") == ["reader: merges"]


@pytest.mark.parametrize(("wcet", "pairs"), [("6 ms", ["sonar + log"]), ("4 ms", [])])
def test_harmless_delays_go_in_neither_order(tmp_path: Path, wcet: str, pairs: list[str]) -> None:
    """Two delays are too much for the deadline, or only all three."""
    chain = "chains: {stop: {through: [sense.sonar, safe.guard], deadline: 70 ms}}\n"
    robot = repositories.repository(tmp_path / "robot", FILES | {"groups/chain.yaml": chain})
    for name, file in (("sonar", "norsk"), ("log", "norsk"), ("guard", "aegir")):
        line = f"{name}: {{implements: {name}, host: pc, timing: {{rate: 50 Hz, wcet: "
        branch(robot, name, {f"groups/{file}.yaml": (f"{line}1 ms", f"{line}{wcet}")})
    merges = merge(robot, "sonar", "log", "guard")
    assert [each for each in merges[:3] if each.findings] == []
    assert [" + ".join(each.branches) for each in merges[3:] if each.goes_in_no_order][:1] == (
        pairs or ["sonar + log + guard"]
    )


def test_what_a_branch_breaks_by_itself_is_told_by_its_own_review(robot: Path) -> None:
    repositories.commit(robot, {file: (robot / file).read_text().replace(*edit) for file, edit in READS.items()})
    branch(robot, "units", UNITS)
    branch(robot, "words", WORDS)
    assert say(robot, "units", "words") == ["units: merges", "words: merges", "units + words: merges"]


def test_a_chain_that_a_branch_makes_late_by_itself_is_not_told_again(tmp_path: Path) -> None:
    chain = "chains: {stop: {through: [sense.sonar, safe.guard], deadline: 70 ms}}\n"
    robot = repositories.repository(tmp_path / "robot", FILES | {"groups/chain.yaml": chain})
    text = FILES["groups/norsk.yaml"]
    branch(robot, "late", {"groups/norsk.yaml": (text, text.replace("wcet: 1 ms", "wcet: 7 ms"))})
    branch(robot, "guard", {"groups/aegir.yaml": ("wcet: 1 ms", "wcet: 1.5 ms")})
    assert say(robot, "late", "guard") == ["late: merges", "guard: merges", "late + guard: merges"]


def test_a_break_under_a_name_that_the_other_branch_gave_is_no_other_break(robot: Path) -> None:
    repositories.commit(robot, {file: (robot / file).read_text().replace(*edit) for file, edit in READS.items()})
    branch(robot, "slow", SLOW)
    branch(
        robot,
        "rename",
        {"groups/norsk.yaml": ("      log:", "      logger:"), "groups/aegir.yaml": ("guard", "watch")},
    )
    renamed = {
        "groups/norsk.yaml": (robot / "groups/norsk.yaml").read_text().replace("log", "logger"),
        "groups/aegir.yaml": (robot / "groups/aegir.yaml").read_text().replace("guard", "watch"),
        "archgen.yaml": (robot / "archgen.yaml").read_text().replace("guard", "watch"),
    }
    repositories.git(robot, "checkout", "-q", "rename")
    repositories.commit(robot, renamed)
    repositories.git(robot, "checkout", "-q", "main")
    assert [line for line in say(robot, "slow", "rename") if "order" in line or "first" in line] == []


def test_a_branch_that_conflicts_is_still_merged_with_all_others(robot: Path) -> None:
    branch(robot, "reader", READS)
    branch(robot, "other", {"groups/aegir.yaml": ("outputs: {stop: Stop}", "outputs: {stop: Halt}")})
    branch(robot, "more", {"groups/aegir.yaml": ("outputs: {stop: Stop}", "outputs: {stop: Brake}")})
    branch(robot, "units", UNITS)
    said = say(robot, "other", "more", "reader", "units")
    assert [line for line in said if not line.endswith(": merges")] == [
        "other + more: conflicts",
        "other + reader: git conflicts needlessly",
        "more + reader: git conflicts needlessly",
        "reader + units: first units, then reader, whose author has to look",
    ]


def test_what_a_branch_breaks_is_told_beside_what_it_conflicts_with(robot: Path) -> None:
    branch(robot, "words", {"groups/norsk.yaml": ("Logs.", "Writes all down.")})
    branch(robot, "other", {"groups/norsk.yaml": ("functionality: Sees.", "functionality: Sees far.")})
    branch(robot, "reader", READS)
    branch(robot, "both", UNITS | {"groups/norsk.yaml": ("functionality: Sees.", "functionality: Sees near.")})
    assert [line for line in say(robot, "words", "other", "reader", "both") if not line.endswith(": merges")] == [
        "words + other: git conflicts needlessly",
        "other + both: conflicts",
        "words + both: git conflicts needlessly",
        "reader + both: first both, then reader, whose author has to look",
    ]


def test_a_project_that_forbids_nothing_is_told_all_the_same(robot: Path) -> None:
    repositories.commit(robot, {"archgen.yaml": FILES["archgen.yaml"].replace("meaning: error", "meaning: warning")})
    branch(robot, "reader", READS)
    branch(robot, "units", UNITS)
    *_, pair = merge(robot, "reader", "units")
    assert [finding.severity for finding in pair.findings] == ["warning"]


def test_what_cannot_be_read_is_not_judged(robot: Path) -> None:
    branch(robot, "reader", READS)
    branch(robot, "broken", {"groups/norsk.yaml": ("groups:\n", "groups: [\n")})
    assert say(robot, "broken", "reader")[0] == (
        "broken: merges; what it breaks cannot be judged: `groups/norsk.yaml` cannot be read"
    )
    # As `archgen diff --breaking` has it: what cannot be judged is refused where breaks are.
    assert [merge.is_refused for merge in merge(robot, "broken", "reader")] == [True, False]


@pytest.mark.parametrize(
    "edits",
    [
        {"groups/norsk.yaml": ("groups:\n", "groups: [\n")},
        {"groups/aegir.yaml": ("Guards.", "Guards., inputs: {x: no.where}")},
    ],
)
def test_a_branch_with_errors_does_not_hide_what_others_do(robot: Path, edits: Edits) -> None:
    branch(robot, "broken", edits)
    branch(robot, "reader", READS)
    branch(robot, "units", UNITS)
    assert "reader + units: first units, then reader, whose author has to look" in say(
        robot, "broken", "reader", "units"
    )


VARIANT = "  deep: {title: Deep water, description: Below 50 m, changes: {nodes: {log: {timing: {rate: 10 Hz}}}}}\n"
SPARE = "      spare: {functionality: Writes down what was seen., inputs: {raw: sonar.raw, profile: sonar.profile}}\n"


@pytest.mark.parametrize(
    ("line", "old_id", "around"),
    [
        (VARIANT, "deep", "variants: {{{}}}\n"),
        (SPARE, "sense.spare", "groups: {{sense: {{components: {{{}}}}}}}\n"),
    ],
)
def test_what_both_sides_renamed_is_a_conflict_also_where_lines_merge(
    tmp_path: Path, line: str, old_id: str, around: str
) -> None:
    files = FILES | {
        "groups/variants.yaml": f"variants:\n{VARIANT}  shallow: {{title: Shallow water}}\n",
        "groups/norsk.yaml": FILES["groups/norsk.yaml"].replace("nodes:\n", f"{SPARE}nodes:\n"),
    }
    robot = repositories.repository(tmp_path / "robot", files)
    file = next(name for name, text in files.items() if line in text)
    name = old_id.rpartition(".")[2]
    for side in ("here", "there"):
        repositories.git(robot, "checkout", "-q", "-b", side, "main")
        moved = around.format(line.strip().replace(name, side, 1))
        repositories.commit(robot, {file: files[file].replace(line, ""), f"groups/{side}.yaml": moved})
        repositories.git(robot, "checkout", "-q", "main")
    *_, pair = merge(robot, "here", "there")
    ids = [old_id.removesuffix(name) + each for each in (name, "here", "there")]
    said = f"both sides renamed `{ids[0]}`: it is `{ids[1]}` and `{ids[2]}` now, and there would be two"
    assert [describe_conflict(each) for each in pair.conflicts] == [f"groups/here.yaml: {said}"]


def test_the_json_says_the_order(robot: Path) -> None:
    branch(robot, "reader", READS)
    branch(robot, "units", UNITS)
    document = json.loads(format_merges_json("main", merge(robot, "reader", "units")))
    schema = json.loads(resources.resource_path("schemas", "merges.schema.json").read_text(encoding="utf-8"))
    jsonschema_rs.validate(schema, document)
    assert [merge["order"] for merge in document["merges"]] == ["any", "any", {"first": ["units"], "then": ["reader"]}]
    assert [len(merge["breaks"]) for merge in document["merges"]] == [0, 0, 1]
