"""Versions of a project that share a cache are judged as if each were alone, down to the last place in a file."""

from __future__ import annotations

import random
import re
import shutil
from importlib import import_module
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare.compare_versions import compare_versions
from archgen.pipeline import CheckedProject, VersionCache
from archgen.products.compared_versions import make_comparison_input
from tests.link.test_variant_exactness import write_robot
from tests.property_sizes import list_seeds

_BENCHMARK = import_module("benchmarks.generate")
_EXAMPLE = Path(__file__).resolve().parents[2] / "example_ramcip"
_WORDS = (
    (r"^(\s+)title: .*$", r"\1title: Another title"),
    (r"\boptional: true", "optional: false"),
    (r"^(\s+)tags: .*$", ""),
    (r"period: \d+ ms", "period: 70 ms"),
    (r"owner: \w+", "owner: {owner}"),
    (r"std_msgs/msg/String", "sensor_msgs/msg/Image"),
    (r"host: pc", "host: other"),
    (r"^$", "# a line more\n"),
    (r"\Z", "\n"),
    (r"\A", "# a line more\n\n"),
)


def describe(checked: CheckedProject) -> tuple[object, ...]:
    """Return all that a check makes: `repr` has the places in files, which `==` leaves out."""
    variants = checked.variants.items()
    return (
        [repr(each) for each in checked.findings],
        repr(checked.architecture),
        checked.analysis and repr((checked.analysis.outputs, checked.analysis.responses)),
        {name: repr(each.architecture) for name, each in variants},
    )


def split_robot(text: str, folder: Path) -> None:
    """Write a project of one text as a file for each of its groups and one for all else."""
    head, _, rest = text.partition("groups:\n")
    groups, _, tail = rest.partition("nodes:\n")
    folder.mkdir()
    (folder / "archgen.yaml").write_text(f"{head}sources: ['*.yaml']\n", encoding="utf-8")
    for number, body in enumerate(re.split(r"(?m)^(?=  g\d+:)", groups)[1:]):
        (folder / f"g{number}.yaml").write_text(f"groups:\n{body}", encoding="utf-8")
    (folder / "nodes.yaml").write_text(f"nodes:\n{tail}", encoding="utf-8")


def change_something(folder: Path, chance: random.Random) -> None:
    """Change a word, add a line, or take one out of a file."""
    file = chance.choice(sorted(folder.rglob("*.yaml")))
    text = file.read_text(encoding="utf-8")
    if chance.random() < 0.3:
        lines = text.splitlines(keepends=True)
        del lines[chance.randrange(len(lines))]
        text = "".join(lines)
    else:
        pattern, words = chance.choice(_WORDS)
        words = words.replace("{owner}", chance.choice(("a", "b", "sssa", "nobody")))
        text = re.sub(pattern, words, text, count=chance.randrange(1, 3), flags=re.MULTILINE)
    file.write_text(text, encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("seed", list_seeds(6))
def test_versions_that_share_a_cache_are_judged_as_if_alone(tmp_path: Path, seed: int) -> None:
    chance, folder, cache = random.Random(seed), tmp_path / "project", VersionCache()  # noqa: S311 - the same each time
    split_robot(write_robot(seed), folder)
    for _ in range(8):
        assert describe(pipeline.check_project(folder, cache)) == describe(pipeline.check_project(folder))
        change_something(folder, chance)


def describe_comparison(before: CheckedProject, after: CheckedProject) -> str:
    """Return the elements of both versions in normal form, and all that differs."""
    found = compare_versions(make_comparison_input(before), make_comparison_input(after))
    return repr((found.versions.elements, found.changes, found.boundaries, found.limits, found.loads))


@pytest.mark.parametrize("seed", list_seeds(4))
def test_versions_that_share_a_cache_are_compared_as_if_alone(tmp_path: Path, seed: int) -> None:
    chance, folder, cache = random.Random(seed), tmp_path / "project", VersionCache()  # noqa: S311 - the same each time
    split_robot(write_robot(seed), folder)
    shared, alone = pipeline.check_project(folder, cache), pipeline.check_project(folder)
    for _ in range(4):
        change_something(folder, chance)
        shared_before, shared = shared, pipeline.check_project(folder, cache)
        alone_before, alone = alone, pipeline.check_project(folder)
        assert describe_comparison(shared_before, shared) == describe_comparison(alone_before, alone)


@pytest.mark.slow
def test_versions_of_the_example_that_share_a_cache_are_judged_as_if_alone(tmp_path: Path) -> None:
    chance, folder, cache = random.Random(30), tmp_path / "project", VersionCache()  # noqa: S311 - the same each time
    shutil.copytree(_EXAMPLE, folder)
    for _ in range(4):
        assert describe(pipeline.check_project(folder, cache)) == describe(pipeline.check_project(folder))
        change_something(folder, chance)


def test_what_two_versions_share_is_listed_once_for_a_comparison(tmp_path: Path) -> None:
    _BENCHMARK.generate(60, tmp_path)
    cache = VersionCache()
    before = pipeline.check_project(tmp_path, cache)
    file = tmp_path / "groups" / "g5.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace("title: Group 5", "title: Other"), encoding="utf-8")
    after = pipeline.check_project(tmp_path, cache)
    found = compare_versions(make_comparison_input(before), make_comparison_input(after))
    old, new = found.versions.elements
    for listed_kind, name in (("component", "g5.c"), ("node", "n5_")):
        anew = {name for (kind, name), each in old.items() if kind == listed_kind and each is not new[kind, name]}
        assert anew == {f"{name}{n}" for n in range(10)}
    assert [change.key for change in found.changes] == ["title"]
    assert not found.boundaries


def test_what_two_versions_share_is_linked_once(tmp_path: Path) -> None:
    _BENCHMARK.generate(60, tmp_path)
    cache = VersionCache()
    before = pipeline.check_project(tmp_path, cache).architecture
    file = tmp_path / "groups" / "g5.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace("title: Group 5", "title: Other"), encoding="utf-8")
    after = pipeline.check_project(tmp_path, cache).architecture
    anew = {name for name, each in before.components.items() if each is not after.components[name]}
    assert {name.partition(".")[0] for name in anew} == {"g5"}
    assert {name for name, each in before.nodes.items() if each is not after.nodes[name]} == {
        f"n5_{n}" for n in range(10)
    }
