"""No verb does more than n log n of anything: counted in calls of functions, which no other load on the machine changes.

`benchmarks/slopes.py` measures seconds, memory and bytes of the same verbs.
"""

from __future__ import annotations

import cProfile
import math
import shutil
import sys
from collections import Counter
from importlib import import_module
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, cast

import pytest
from click.testing import CliRunner

from archgen.cli import main
from tests.property_sizes import try_some
from tests.running import ROOT

if TYPE_CHECKING:
    from _typeshed import TraceFunction

_BENCHMARK = import_module("benchmarks.generate")
_STEEPEST = 1.3
"""n log n has 1.2 between 60 and 240; a loop within a loop has 2."""
_FEW_CALLS = 3_000
"""So many more calls are nothing, whatever their slope: a sorted list of 200 names takes some hundreds."""
# Of 40 components each has one requirement: only those beyond are told of.
_SIZES = {"components": (60, 120, 240), "variants": (6, 12, 24), "requirements": (60, 120, 240)}
_OTHER_SIZES = (30, 60, 120)
_VERBS: dict[str, tuple[str, ...]] = {
    "check": ("check", "{project}"),
    "pack": ("pack", "{project}", "-o", "{out}/packed.yaml"),
    "list": ("list", "-C", "{project}", "--of", "connections"),
    "show": ("show", "-C", "{project}", "g0.c0"),
    "schema": ("schema", "{project}", "-o", "{out}/schema.json"),
    "start": ("start", "{project}"),
    "stats": ("stats", "{project}"),
    "owners": ("owners", "{project}"),
    "interfaces": ("interfaces", "-C", "{project}", "--between", "p0", "p1", "-o", "{out}/p0-p1.md"),
    "diff": ("diff", "{project}", "{changed}"),
    "transform": ("transform", "flatten", "-C", "{project}", "-o", "{out}/flat.yaml"),
    "reqif": ("export", "reqif", "-C", "{project}", "-o", "{out}/all.reqif"),
    "csv": ("build", "{project}", "--only", "csv", "-o", "{out}/all"),
    "find": ("find", "-C", "{project}", "Component"),
    "todo": ("todo", "{project}", "--partner", "p0"),
    "impact": ("impact", "{project}", "--partner", "p0"),
    "fmt": ("fmt", "--diff", "{project}"),
    "launch": ("generate", "ros2_launch", "-C", "{project}", "-o", "{out}/launch"),
    "rename": ("rename", "g0.c0", "fresh", "--dry-run", "-C", "{project}"),
    "move": ("move", "g0.c0", "--file", "moved.yaml", "--dry-run", "-C", "{project}"),
}
_PLAIN_VERBS = frozenset({"pack", "list", "schema", "start", "owners", "find", "fmt"})
"""What does nothing of its own with chains and variants: a check is all of it."""
_INSTANCES_VERBS = {"rename in a type": ("rename", "filter.clean", "tidy", "--dry-run", "-C", "{project}")}
_Calls = dict[tuple[str, int, str], int]


def count_calls(words: list[str]) -> _Calls:
    """Run a verb, and count how often each function was called."""
    profile = cProfile.Profile()
    profile.enable()
    done = CliRunner().invoke(main, words)
    profile.disable()
    assert done.exit_code in (0, 1), done.output
    profile.create_stats()
    stats = cast("dict[tuple[str, int, str], tuple[int, int]]", profile.stats)
    return {place: calls for place, (_, calls, *_) in stats.items()}


def count_lines(words: list[str]) -> _Calls:
    """Run a verb, and count how many lines each function of the views runs: turns of loops that call nothing are seen, too."""
    views = str(ROOT / "archgen" / "views")
    lines: Counter[tuple[str, int, str]] = Counter()

    def trace(frame: FrameType, event: str, _: object) -> TraceFunction | None:
        code = frame.f_code
        if not code.co_filename.startswith(views):
            return None
        lines[code.co_filename, code.co_firstlineno, code.co_name] += event == "line"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        done = CliRunner().invoke(main, words)
    finally:
        sys.settrace(before)
    assert done.exit_code in (0, 1), done.output
    return lines


def find_steep(counts: list[_Calls]) -> list[str]:
    """Name the functions whose calls grow faster than n log n, whatever constant number of them there is."""
    steep = []
    for place, most in counts[2].items():
        few, more = counts[0].get(place, 0), counts[1].get(place, 0)
        if most - few > _FEW_CALLS and more > few and most > more:
            slope = math.log2((most - more) / (more - few))
            if slope > _STEEPEST:
                steep.append(f"{place[0]}:{place[1]} {place[2]}: {few}, {more}, {most} calls, slope {slope:.2f}")
    return steep


def make_projects(dimension: str, folder: Path) -> list[Path]:
    """Make projects in which one thing doubles, each beside the same with one title changed."""
    projects = []
    for size in _SIZES.get(dimension, _OTHER_SIZES):
        project = folder / str(size) / "project"
        if dimension == "components":
            _BENCHMARK.generate(size, project)
        else:
            _BENCHMARK.generate(40, project, _BENCHMARK.Amounts(**{dimension: size}))
        changed = project.parent / "changed"
        shutil.copytree(project, changed)
        file = changed / "groups" / "g0.yaml"
        file.write_text(
            file.read_text(encoding="utf-8").replace("title: Component 0.0", "title: Other"), encoding="utf-8"
        )
        projects.append(project)
    return projects


_DIMENSIONS = ("components", "variants", "partners", "chains", "requirements", "instances")


@pytest.mark.parametrize("dimension", try_some(_DIMENSIONS, 0, 1))
def test_no_verb_calls_anything_more_than_n_log_n_times(dimension: str, tmp_path: Path) -> None:
    projects = make_projects(dimension, tmp_path)
    steep = []
    verbs = _VERBS | (_INSTANCES_VERBS if dimension == "instances" else {})
    if dimension in {"chains", "variants"}:
        verbs = {verb: words for verb, words in verbs.items() if verb not in _PLAIN_VERBS}
    for verb, words in verbs.items():
        count_calls(_fill_in(words, projects[0]))  # what is imported or made once is not counted
        steep += [f"{verb}: {each}" for each in find_steep([count_calls(_fill_in(words, each)) for each in projects])]
    assert not steep, "\n".join(steep)


def test_no_loop_of_an_export_takes_more_than_n_log_n_turns(tmp_path: Path) -> None:
    words = ("export", "mermaid", "-C", "{project}", "-o", "{out}/m.md")
    projects = make_projects("components", tmp_path)
    count_lines(_fill_in(words, projects[0]))
    steep = find_steep([count_lines(_fill_in(words, each)) for each in projects])
    assert not steep, "\n".join(steep)


def _fill_in(words: tuple[str, ...], project: Path) -> list[str]:
    places = {"project": str(project), "changed": str(project.parent / "changed"), "out": str(project.parent)}
    return [word.format(**places) for word in words]


def test_a_loop_within_a_loop_is_steep() -> None:
    def count_pairs(length: int) -> _Calls:
        return {
            ("pairs.py", 1, "pair"): 5_000 + length * length,
            ("sort.py", 1, "sort"): length * length.bit_length() * 99,
        }

    assert find_steep([count_pairs(length) for length in (80, 160, 320)]) == [
        "pairs.py:1 pair: 11400, 30600, 107400 calls, slope 2.00"
    ]
