"""Random pairs of branches that rename, move, split, edit and add: what merges says what both say, what contradicts never merges.

The truth is made without a merge: what the other branch did is done once more, on ours, to the elements as they are called there.
"""

from __future__ import annotations

import random
import shutil
from collections import Counter
from importlib import import_module
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.edit.element_edit import EditRefusedError
from archgen.edit.refactoring.element_move import plan_move, plan_split
from archgen.edit.refactoring.element_rename import plan_rename
from archgen.edit.refactoring.judged_version import JudgedVersion, judge_edited, judge_version
from archgen.frozen import NamedTuple
from archgen.merge.branch_results import BranchMerge
from archgen.merge.head_merge import merge_into_head
from archgen.merge.tree_merge import MappingValue, MergedValue, read_merged_value
from archgen.pipeline import CheckedProject, check_project
from archgen.products.merge_breaks import BRANCH_JUDGES
from archgen.project import load_project
from tests import repositories
from tests.property_sizes import try_some

_BENCHMARK = import_module("benchmarks.generate")
_CASE_STUDY = Path(__file__).resolve().parents[2] / "example_ramcip"
_CANNOT = "not in this way"
_MOST_NEEDLESS = 0.1
"""The share of pairs without a contradiction that may be refused all the same: to be careful is no fault, to be no use is one."""


class Change(NamedTuple):
    """Something that a branch does: to which element, by its first id, and with which word."""

    verb: str
    kind: str
    element: str
    word: str

    def contradicts(self, other: Change) -> bool:
        """Whether two branches that do this each want something else of one element."""
        is_same = (self.verb, self.kind, self.element) == (other.verb, other.kind, other.element)
        return is_same and self.verb in {"rename", "title", "group"} and self.word != other.word

    def may_hinder(self, other: Change) -> bool:
        """Whether two branches that do this each give something a path or a file of their own."""
        if {self.verb, other.verb} == {"rename", "group"} and self.element == other.element:
            return True
        return bool({self.verb, other.verb} & {"file"}) and {self.verb, other.verb} <= {"file", "split"}


class Branch:
    """A version of the project that is changed; it knows what elements were called first."""

    def __init__(self, version: JudgedVersion) -> None:
        self.version = version
        self.contents: dict[str, bytes] = {}
        self.done: list[Change] = []
        self._renames: list[tuple[str, str, str]] = []

    def name_of(self, kind: str, first_id: str) -> str:
        """Return what an element is called here that had an id at first."""
        for renamed_kind, old, new in self._renames:
            is_inner = renamed_kind in {"group", "component"} and kind in {"group", "component", "output", "input"}
            if renamed_kind == kind and first_id == old:
                first_id = new
            elif is_inner and first_id.startswith(f"{old}."):
                first_id = new + first_id[len(old) :]
        return first_id

    def do(self, change: Change) -> bool:
        """Make a change; return whether that could be done."""
        try:
            self._do(change)
        except EditRefusedError:
            return False
        self.done.append(change)
        return True

    def _do(self, change: Change) -> None:
        name = self.name_of(change.kind, change.element)
        element = (change.kind, name)
        if change.verb == "rename":
            self._write({edit.file: edit.new_content for edit in plan_rename(self.version, element, change.word).edits})
            group = name.rpartition(".")[0] if change.kind in {"group", "component", "output"} else ""
            self._renames.append((change.kind, name, f"{group}.{change.word}" if group else change.word))
        elif change.verb == "group":
            self._write(
                {each.file: each.new_content for each in plan_move(self.version, element, change.word, None).edits}
            )
            self._renames.append(("component", name, f"{change.word}.{name.rpartition('.')[2]}"))
        elif change.verb == "file":
            self._write(
                {each.file: each.new_content for each in plan_move(self.version, element, None, change.word).edits}
            )
        elif change.verb == "split":
            self._write({each.file: each.new_content for each in plan_split(self.version, change.element, None).edits})
        else:
            self._edit(change, name)

    def _write(self, contents: dict[str, bytes]) -> None:
        self.version = judge_edited(self.version, contents)
        self.contents |= contents

    def _edit(self, change: Change, name: str) -> None:
        """Write a title over, or put a component before the first one of a group."""
        architecture = self.version.project.architecture
        if change.verb == "add":
            own = (each for each in architecture.components.values() if each.id.startswith(f"{name}."))
            components = [each for each in own if not each.id.rpartition(".")[2].startswith("group_")]
            output = self.name_of("output", change.word)
            if not components or output not in architecture.outputs:
                raise EditRefusedError(_CANNOT)
            at, new_line = (
                components[0].at,
                f"{change.kind}_{change.word.replace('.', '_')}: {{inputs: {{seen: {output}}}}}",
            )
        else:
            if name not in architecture.components:
                raise EditRefusedError(_CANNOT)
            at, new_line = architecture.components[name].at, f"title: {change.word}"
        lines = (self.version.project.sources.text_of(at.file) or "").splitlines(keepends=True)
        first = lines[at.line - 1]
        indent = first[: len(first) - len(first.lstrip())]
        if not first.rstrip().endswith(":"):
            raise EditRefusedError(_CANNOT)  # in braces
        if change.verb == "add":
            start = at.line - 1
            while lines[start - 1].startswith(f"{indent}#"):
                start -= 1
            lines.insert(start, f"{indent}{new_line}\n")
        else:
            end = next((n for n in range(at.line, len(lines)) if not lines[n].startswith(f"{indent} ")), len(lines))
            found = [n for n in range(at.line, end) if lines[n].startswith(f"{indent}  title:")]
            lines[found[0] if found else at.line : (found[0] + 1) if found else at.line] = [f"{indent}  {new_line}\n"]
        self._write({at.file: "".join(lines).encode()})


def draw_change(version: JudgedVersion, rng: random.Random, number: int) -> Change:
    architecture = version.project.architecture
    components = [each.id for each in architecture.components.values() if not each.type_name]
    groups = [
        each for each in architecture.groups if "." not in each and any(c.startswith(f"{each}.") for c in components)
    ]
    component, group = rng.choice(components), rng.choice(groups)
    output = rng.choice([each for each in architecture.outputs if each.rpartition(".")[0] in components])
    kinds = {
        "component": component,
        "output": output,
        "group": group,
        "requirement": rng.choice([*architecture.requirements]),
        "chain": rng.choice([*architecture.chains]),
        "partner": rng.choice([*architecture.partners]),
    }
    verb = rng.choice(["rename", "rename", "rename", "title", "title", "title", "add", "add", "file", "group", "split"])
    if verb == "rename":
        kind = rng.choice([*kinds, "component", "output"])
        return Change(verb, kind, kinds[kind], f"other{number}")
    if verb == "title":
        return Change(verb, "component", component, f"Said otherwise {number}")
    if verb == "add":
        return Change(verb, "group", group, output)
    if verb == "split":
        return Change(verb, "file", architecture.components[component].at.file, "")
    return Change(verb, "component", component, f"groups/new{number}.yaml" if verb == "file" else group)


def read_meaning(project: CheckedProject) -> MergedValue:
    value = read_merged_value(project.merged_table)
    assert isinstance(value, MappingValue)
    return MappingValue(tuple((key, each) for key, each in value.items if key != "sources"))


def is_sound(merge: BranchMerge) -> bool:
    return not merge.is_blocked and not any(each.severity is Severity.ERROR for each in merge.findings)


def try_pair(folder: Path, version: JudgedVersion, rng: random.Random, *, is_close: bool) -> str:
    """Merge a random pair of branches; return what came out."""
    repositories.git(folder, "checkout", "-q", "-f", "main")
    ours, theirs = Branch(version), Branch(version)
    for number in range(rng.randint(1, 3)):
        ours.do(draw_change(version, rng, number))
    for number in range(rng.randint(1, 3)):
        change = draw_change(version, rng, number + 10)
        # Two branches rarely meet by chance: let one do something to what the other one touched.
        touched = [each for each in ours.done if each.kind == change.kind]
        if is_close and touched:
            change = change._replace(element=rng.choice(touched).element)
        theirs.do(change)
    for name, branch in (("ours", ours), ("theirs", theirs)):
        repositories.git(folder, "checkout", "-q", "-B", name, "main")
        for file, content in branch.contents.items():
            is_empty = not any(line.strip() and not line.startswith(b"#") for line in content.splitlines())
            (folder / file).parent.mkdir(exist_ok=True)
            (folder / file).unlink(missing_ok=True) if is_empty else (folder / file).write_bytes(content)
        repositories.commit(folder, {})
    repositories.git(folder, "checkout", "-q", "ours")
    merge = merge_into_head(folder, "theirs", BRANCH_JUDGES, is_sound)
    story = f"{ours.done} | {theirs.done} | {merge.branch_merge.conflicts} {merge.branch_merge.new_findings}"
    contradictions = [(a, b) for a in ours.done for b in theirs.done if a.contradicts(b)]
    if not merge.is_written and not merge.is_needless:
        is_hindered = any(a.may_hinder(b) for a in ours.done for b in theirs.done)
        return "refused" if contradictions or is_hindered else f"needless: {story}"
    merged = check_project(folder)
    repositories.git(folder, "reset", "-q", "--hard", "main")
    assert not contradictions, story
    for change in theirs.done:
        if change.verb not in {"file", "split"} and not ours.do(change):
            return f"without truth: {story}"
    assert read_meaning(merged) == read_meaning(ours.version.project), story
    return "merged"


_BLOCKS = [
    ("case study", range(1)),
    *(("generated", range(first, first + 12)) for first in range(0, 60, 12)),
    ("case study", range(1, 3)),
]


@pytest.mark.parametrize(("name", "numbers"), try_some(_BLOCKS, 0, 3))
def test_no_pair_of_branches_merges_into_what_neither_says(tmp_path: Path, name: str, numbers: range) -> None:
    folder = tmp_path / "robot"
    if name == "generated":
        amounts = _BENCHMARK.Amounts(partners=3, chains=2, instances=2, variants=1)
        _BENCHMARK.generate(20, folder, amounts)
    else:
        shutil.copytree(_CASE_STUDY, folder, ignore=shutil.ignore_patterns("archgen-out"))
    repositories.repository(folder, {})
    version = judge_version(load_project(folder))
    outcomes = Counter(
        try_pair(folder, version, random.Random(f"{name} {number}"), is_close=number % 2 == 0)  # noqa: S311 - no secret
        for number in numbers
    )
    kinds = Counter[str]()
    for outcome, times in outcomes.items():
        kinds[outcome.partition(":")[0]] += times
    needless = [outcome for outcome in outcomes if outcome.startswith(("needless", "without"))]
    assert len(needless) <= _MOST_NEEDLESS * len(numbers), "\n".join(needless)
    assert kinds["merged"] > len(numbers) / 2, kinds
