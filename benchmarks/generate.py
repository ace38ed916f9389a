"""Make a project of any size: groups of ten components, as people write them, wired as robots are.

Usage: python benchmarks/generate.py COMPONENTS FOLDER. The same number gives the same files.
"""

from __future__ import annotations

import random
import sys
from pathlib import Path

_GROUP = 10
_TYPES = ("Point cloud", "Colour image", "Odometry", "Path", "Joint states", "Laser scan")


def generate(components: int, folder: Path) -> None:
    """Write a project with this many components into a folder."""
    groups = (components + _GROUP - 1) // _GROUP
    wiring = random.Random(components)  # noqa: S311 - reproducible wiring, no secret
    (folder / "groups").mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(_project(groups), encoding="utf-8")
    for group in range(groups):
        size = min(_GROUP, components - group * _GROUP)
        text = _group(group, size, wiring)
        (folder / "groups" / f"g{group}.yaml").write_text(text, encoding="utf-8")


def _project(groups: int) -> str:
    partners = "".join(f"  p{i}: {{title: Partner {i}}}\n" for i in range(8))
    requirements = "".join(f"  R-{i}: {{title: The robot does thing {i}}}\n" for i in range(groups))
    return (
        "archgen: 1\nproject: {id: bench, title: Generated robot}\nros: {distro: jazzy}\n"
        f"sources: ['groups/*.yaml']\npartners:\n{partners}requirements:\n{requirements}"
    )


def _group(group: int, size: int, wiring: random.Random) -> str:
    lines = ["groups:", f"  g{group}:", f"    title: Group {group}", f"    owner: p{group % 8}", "    components:"]
    for number in range(size):
        lines += _component(group, number, wiring)
    lines.append("nodes:")
    for number in range(size):
        lines += _node(group, number)
    return "\n".join(lines) + "\n"


def _component(group: int, number: int, wiring: random.Random) -> list[str]:
    kind = _TYPES[number % len(_TYPES)]
    lines = [
        f"      c{number}:",
        f"        title: Component {group}.{number}",
        f"        functionality: Turns what the components before it give into {kind.lower()} number {group}.",
        f"        requirements: [R-{group}, 'Works within {number + 1} m']",
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


if __name__ == "__main__":
    generate(int(sys.argv[1]), Path(sys.argv[2]))
