"""Make a project of any size: groups of ten components, as people write them, wired as robots are.

Usage: python benchmarks/generate.py COMPONENTS FOLDER [--partners N] [--requirements N] [--chains N] [--instances N]
[--variants N]. The same numbers give the same files.
"""

from __future__ import annotations

import argparse
import random
from dataclasses import dataclass
from pathlib import Path

_GROUP = 10
_TYPES = ("Point cloud", "Colour image", "Odometry", "Path", "Joint states", "Laser scan")


@dataclass(frozen=True)
class Amounts:
    """How much there is of what a project has beside its components. `requirements` is 0 for one of each group."""

    partners: int = 8
    requirements: int = 0
    chains: int = 0
    instances: int = 0
    variants: int = 0


def generate(components: int, folder: Path, amounts: Amounts = Amounts()) -> None:
    """Write a project with this many components into a folder."""
    groups = (components + _GROUP - 1) // _GROUP
    wiring = random.Random(components)  # noqa: S311 - reproducible wiring, no secret
    (folder / "groups").mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(_project(groups, amounts), encoding="utf-8")
    for group in range(groups):
        size = min(_GROUP, components - group * _GROUP)
        text = _group(group, size, wiring, amounts)
        (folder / "groups" / f"g{group}.yaml").write_text(text, encoding="utf-8")


def _project(groups: int, amounts: Amounts) -> str:
    partners = "".join(f"  p{i}: {{title: Partner {i}}}\n" for i in range(amounts.partners))
    requirements = "".join(
        f"  R-{i}: {{title: The robot does thing {i}}}\n" for i in range(amounts.requirements or groups)
    )
    return (
        "archgen: 1\nproject: {id: bench, title: Generated robot}\nros: {distro: jazzy}\n"
        f"sources: ['groups/*.yaml']\npartners:\n{partners}requirements:\n{requirements}"
        + _chains(groups, amounts.chains)
        + _instances(groups, amounts.instances)
        + _variants(groups, amounts.variants)
    )


def _chains(groups: int, count: int) -> str:
    """Lead each chain through a group, or through less of it where groups have several; none through what variants lack."""
    lines = [
        f"  chain_{i}: {{through: [{', '.join(f'n{i % groups}_{n}' for n in range(i // groups % 7, _GROUP - 1))}], deadline: 1 s}}\n"
        for i in range(count)
    ]
    return "".join(["chains:\n", *lines]) if lines else ""


def _instances(groups: int, count: int) -> str:
    """Make instances of one component type, in groups of ten; each reads an output of a group."""
    if not count:
        return ""
    type_text = (
        "component_types:\n  filter:\n    title: Filter\n    functionality: Leaves out what is noise.\n    requirements: [R-0]\n"
        "    inputs: {raw: Point cloud}\n    outputs: {clean: Point cloud}\n    parameters: {window: {type: integer, value: 5}}\n"
        "    node: {package: bench_filter, executable: filter}\n    timing: {behaviour: event, wcet: 1 ms}\n"
        "groups:\n"
    )
    lines = [type_text]
    for number in range(count):
        if not number % _GROUP:
            lines.append(f"  filters_{number // _GROUP}:\n    title: Filters {number // _GROUP}\n    components:\n")
        lines.append(
            f"      f{number}: {{is: filter, inputs: {{raw: g{number % groups}.c0.data}}, parameters: {{window: {number + 1}}}}}\n"
        )
    return "".join(lines)


def _variants(groups: int, count: int) -> str:
    """Make variants that leave out a component or change a timing."""
    lines = [
        f"  v{i}: {{changes: {{nodes: {{n{i % groups}_1: {{timing: {{wcet: {i + 1} us}}}}}}}}}}\n"
        if i % 2
        else f"  v{i}: {{without: g{i % groups}.c9}}\n"
        for i in range(count)
    ]
    return "".join(["variants:\n", *lines]) if lines else ""


def _group(group: int, size: int, wiring: random.Random, amounts: Amounts) -> str:
    lines = [
        "groups:",
        f"  g{group}:",
        f"    title: Group {group}",
        f"    owner: p{group % amounts.partners}",
        "    components:",
    ]
    for number in range(size):
        lines += _component(group, number, wiring, amounts)
    lines.append("nodes:")
    for number in range(size):
        lines += _node(group, number)
    return "\n".join(lines) + "\n"


def _component(group: int, number: int, wiring: random.Random, amounts: Amounts) -> list[str]:
    requirement = (group * _GROUP + number) % amounts.requirements if amounts.requirements else group
    kind = _TYPES[number % len(_TYPES)]
    owner = (group * _GROUP + number) % amounts.partners
    lines = [
        f"      c{number}:",
        f"        title: Component {group}.{number}",
        *([f"        owner: p{owner}"] if amounts.partners != Amounts.partners else []),
        f"        functionality: Turns what the components before it give into {kind.lower()} number {group}.",
        f"        requirements: [R-{requirement}, 'Works within {number + 1} m']",
        "        performance:",
        f"          quality: {{accuracy: '9{number} %', execution_time: {number + 5} ms}}",
        "        inputs:",
    ]
    sources = _sources(group, number, wiring)
    lines += [f"          i{place}: {source}" for place, source in enumerate(sources)]
    if not sources:
        lines.append("          world: {external: The world, medium: physical}")
    return [
        *lines,
        "        outputs:",
        f"          data: {kind}",
        f"          state: {{type: {kind}, description: the same}}",
    ]


def _sources(group: int, number: int, wiring: random.Random) -> list[str]:
    sources = [f"c{number - 1}.data"] if number else []
    if group:
        other = wiring.randrange(max(0, group - 6), group)
        sources.append(f"g{other}.c{wiring.randrange(_GROUP)}.{wiring.choice(['data', 'state'])}")
    return sources


def _node(group: int, number: int) -> list[str]:
    return [
        f"  n{group}_{number}:",
        f"    implements: g{group}.c{number}",
        f"    package: bench_{group}",
        "    status: planned",
        f"    timing: {{behaviour: periodic, rate: {number + 1} Hz, wcet: {number + 5} ms}}",
    ]


def main() -> None:
    """Generate what the command line asks for."""
    parser = argparse.ArgumentParser(description="Make a project of any size.")
    parser.add_argument("components", type=int)
    parser.add_argument("folder", type=Path)
    for name, default in vars(Amounts()).items():
        parser.add_argument(f"--{name}", type=int, default=default)
    given = vars(parser.parse_args())
    generate(given.pop("components"), given.pop("folder"), Amounts(**given))


if __name__ == "__main__":
    main()
