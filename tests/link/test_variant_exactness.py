"""A variant is judged as the project that it is: the findings are those of what `archgen pack --variant` writes."""

from __future__ import annotations

import random
from collections import Counter
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.pipeline import CheckedProject
from archgen.syntax.yaml_writer import write_yaml

_TYPES = ("std_msgs/msg/String", "sensor_msgs/msg/Image")
_GROUPS, _PARTS = 3, 4


def write_robot(seed: int) -> str:
    """Return a project at random with three variants: what they take out, write and drop differs, and some are built on others."""
    chance = random.Random(seed)  # noqa: S311 - the same robots each time
    ids = [f"g{group}.c{part}" for group in range(_GROUPS) for part in range(_PARTS)]
    lines = [
        "archgen: 1",
        "ros: {distro: jazzy}",
        "partners: {a: A, b: B}",
        "hosts: {pc: {cores: 2}, other: }",
        "groups:",
    ]
    for group in range(_GROUPS):
        lines += [f"  g{group}:", f"    owner: {chance.choice('ab')}", "    components:"]
        for part in range(_PARTS):
            sources = chance.sample(ids, chance.randrange(3))
            inputs = ", ".join(
                f"i{at}: {{from: {each}, optional: {str(chance.random() < 0.5).lower()}}}"
                for at, each in enumerate(sources)
            )
            promise = chance.choice(("", ", promise: {rate: 20 Hz}", ", deprecated: {until: 2999-01-01}"))
            tags = chance.choice(("", "tags: [hardware], "))
            lines.append(
                f"      c{part}: {{{tags}inputs: {{{inputs}}}, outputs: {{o: {{type: {chance.choice(_TYPES)}{promise}}}}}}}"
            )
    lines.append("nodes:")
    for at, each in enumerate(ids):
        timing = chance.choice(
            ("", f", timing: {{period: {chance.choice((20, 100))} ms, wcet: {chance.randrange(1, 30)} ms}}")
        )
        lines.append(
            f"  n{at}: {{implements: {each}, package: p, executable: e{at}, host: {chance.choice(('pc', 'other'))}{timing}}}"
        )
    lines += [
        f"chains: {{way: {{through: [{ids[0]}, {ids[5]}]}}}}",
        f"views: {{some: {{show: '{ids[1]}+ {ids[2]}'}}}}",
        "variants:",
    ]
    lines += [
        f"  first: {{without: '{chance.choice((*ids, 'tag:hardware', 'owner:b'))}'}}",
        f"  second: {{of: first, changes: {{nodes: {{n1: {{host: pc, timing: {{period: {chance.choice((10, 50))} ms, wcet: 5 ms}}}}}}}}}}",
        f"  third: {{drop: [nodes.n{chance.randrange(12)}.host], changes: {{groups: {{g0: {{components: {{c0: {{title: Other, outputs: {{o: {{type: {_TYPES[0]}}}}}}}}}}}}}}}}}",
    ]
    return "\n".join(lines) + "\n"


def count_findings(checked: CheckedProject) -> Counter[tuple[str, str, str | None]]:
    """Return what is found, without places: a packed file has others. What became of a selector's words has no place in one."""
    return Counter(
        (finding.rule, finding.message, finding.element)
        for finding in checked.findings
        if finding.rule not in {"empty-variant-selector", "missing-variant-part", "undeclared-element"}
    )


@pytest.mark.parametrize("seed", range(8))
def test_a_variant_has_the_findings_of_what_is_packed_of_it(tmp_path: Path, seed: int) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(write_robot(seed), encoding="utf-8")
    checked = pipeline.check_project(file)
    assert set(checked.variants) == {"first", "second", "third"}
    for name, variant in checked.variants.items():
        packed = variant.pack_project()
        written = tmp_path / f"{name}.yaml"
        written.write_text(write_yaml(packed.data, packed.comments), encoding="utf-8")
        assert count_findings(variant) == count_findings(pipeline.check_project(written)), name
        # Judged alone, it is judged the same: nothing of the project itself is left over.
        alone = pipeline.stand_in_variants(pipeline.check_project(file, variants=[]), [name])
        assert alone.findings == variant.findings, name
