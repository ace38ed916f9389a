"""A variant is judged as the project that it is: the findings are those of what `archgen pack --variant` writes."""

from __future__ import annotations

import dataclasses
import random
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.checking.checked_packing import pack_checked_project
from archgen.pipeline import CheckedProject
from archgen.syntax.yaml_writer import write_yaml
from tests.property_sizes import list_seeds

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


@pytest.mark.parametrize("seed", list_seeds(8))
def test_a_variant_has_the_findings_of_what_is_packed_of_it(tmp_path: Path, seed: int) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(write_robot(seed), encoding="utf-8")
    checked = pipeline.check_project(file)
    assert set(checked.variants) == {"first", "second", "third"}
    for name, variant in checked.variants.items():
        packed = pack_checked_project(variant)
        written = tmp_path / f"{name}.yaml"
        written.write_text(write_yaml(packed.data, packed.comments), encoding="utf-8")
        assert count_findings(variant) == count_findings(pipeline.check_project(written)), name
        # Judged alone, it is judged the same: nothing of the project itself is left over.
        alone = pipeline.stand_in_variants(pipeline.check_project(file, variants=[]), [name])
        assert alone.findings == variant.findings, name


def write_varied_robot(seed: int) -> str:
    """Return a project at random in which much is left to be found out, and variants that change what others rest on."""
    chance = random.Random(seed)  # noqa: S311 - the same robots each time
    groups = [f"g{number}" for number in range(3)]
    ids = [f"{group}.c{part}" for group in groups for part in range(chance.randrange(2, 5))]
    sources = (*ids, *groups, *(f"{each}.o" for each in ids), *(f"{each.partition('.')[2]}.o" for each in ids), "lost")
    lines = [
        "archgen: 1",
        f"project: {{middleware: {chance.choice(('ros', 'mqtt'))}}}",
        f"ros: {{distro: jazzy, shared_topics: [{chance.choice(('/tf', '/o'))}]}}",
        "partners: {a: A, b: B}",
        "hosts: {pc: {cores: 2}, other: }",
        "containers: {box: {host: pc}, free: }",
        "resources: {bus: {host: pc}}",
        f"types: {{Data: {{message: {chance.choice(_TYPES)}, size: 1 kB}}, Other: {{message: {_TYPES[1]}}}}}",
        "groups:",
    ]
    for group in groups:
        lines += [f"  {group}:", f"    owner: {chance.choice('ab')}", "    components:"]
        for component_id in (each for each in ids if each.startswith(f"{group}.")):
            inputs = ", ".join(
                f"i{at}: {{from: [{', '.join(chance.sample(sources, chance.randrange(1, 3)))}]{chance.choice(('', ', freshness: 1 s', ', optional: true', ', type: Data'))}}}"
                for at in range(chance.randrange(3))
            )
            said = chance.choice(
                ("", "", ", medium: can", ", promise: {rate: 20 Hz}", ", frame: base", ", external: World")
            )
            own = chance.choice(("", "owner: a, ", "tags: [hardware], ", "timing: {rate: 10 Hz, wcet: 2 ms}, "))
            lines.append(
                f"      {component_id.partition('.')[2]}: {{{own}inputs: {{{inputs}}}, outputs: {{o: {{type: {chance.choice(('Data', 'Other', 'Third'))}{said}}}, p: }}}}"
            )
    lines.append("nodes:")
    for at, each in enumerate(chance.sample(ids, len(ids) - 1)):
        both = chance.choice((each, each, f"[{each}, {chance.choice(ids)}]"))
        place = chance.choice(("host: pc", "host: other", "container: box", "container: free"))
        rest = chance.choice(
            (
                "",
                ", timing: {period: 20 ms, wcet: 3 ms}",
                ", timing: {wcet: 3 ms, uses: {bus: {max: 1 ms}}}",
                f", start: {{after: [{chance.choice(ids)}]}}",
                ", publishes: {o: {topic: /o}}",
                ", internal: {publishes: {x: {message: std_msgs/msg/String}}}",
                ", threads: 3",
            )
        )
        lines.append(f"  n{at}: {{implements: {both}, package: p, executable: e{at}, {place}{rest}}}")
    changes = (
        "project: {middleware: zenoh}",
        "ros: {shared_topics: [/o]}",
        f"types: {{Data: {{message: {_TYPES[1]}}}}}",
        "types: {Data: {size: 2 MB}}",
        "containers: {box: {host: other}}",
        "containers: {free: {host: pc, threads: 2}}",
        "hosts: {pc: {cores: 4}}",
        "groups: {g0: {owner: b}}",
        "groups: {g1: {components: {c0: {outputs: {o: {medium: can}}}}}}",
        "groups: {g1: {components: {c0: {outputs: {extra: {type: Data}}}}}}",
        "groups: {g1: {components: {o: {outputs: {lost: {type: Data}}}}}}",
        "groups: {g2: {components: {c1: {inputs: {new: {from: g0}}}}}}",
        "groups: {g2: {components: {c1: {timing: {rate: 7 Hz, wcet: 1 ms}}}}}",
        "nodes: {n0: {timing: {period: 7 ms, wcet: 2 ms}}}",
        "nodes: {n1: {host: pc, publishes: {o: {topic: /elsewhere}}}}",
        f"nodes: {{extra: {{implements: {chance.choice(ids)}, package: p, executable: x, host: pc}}}}",
        "resources: {bus: {host: other}}",
    )
    drops = (
        "hosts.other",
        "partners.b",
        "nodes.n0",
        "containers.box",
        "types.Data",
        "groups.g0.owner",
        "groups.g1.components.c0.outputs.o",
    )
    withouts = (*ids, *groups, "tag:hardware", "owner:b")
    lines.append("variants:")
    for number in range(5):
        of = f"of: v{chance.randrange(number)}, " if number and chance.random() < 0.4 else ""
        parts = [f"changes: {{{chance.choice(changes)}}}"] if chance.random() < 0.7 else []
        parts += [f"drop: [{chance.choice(drops)}]"] if chance.random() < 0.4 else []
        parts += [f"without: '{chance.choice(withouts)}'"] if not parts or chance.random() < 0.4 else []
        lines.append(f"  v{number}: {{{of}{', '.join(parts)}}}")
    return "\n".join(lines) + "\n"


def list_all(value: object) -> object:
    """Return a value taken apart into all that it is made of: places, too, which take no part in comparisons."""
    if dataclasses.is_dataclass(value):
        fields = [(field.name, list_all(getattr(value, field.name))) for field in dataclasses.fields(value)]
        return (type(value).__name__, fields)
    if isinstance(value, Mapping):
        return [(list_all(key), list_all(each)) for key, each in value.items()]
    if isinstance(value, (tuple, list)):
        return (type(value).__name__, [list_all(each) for each in value])
    return value


@pytest.mark.parametrize("seed", list_seeds(12))
@pytest.mark.parametrize("write", [write_robot, write_varied_robot])
def test_what_variants_share_is_as_if_each_had_been_judged_alone(
    tmp_path: Path, write: Callable[[int], str], seed: int
) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(write(seed), encoding="utf-8")
    checked = pipeline.check_project(file)
    assert checked.variants
    base = pipeline.check_project(file, variants=[])
    assert list_all(base.architecture) == list_all(checked.architecture)
    for name, variant in checked.variants.items():
        alone = pipeline.stand_in_variants(base, [name])
        assert list_all(alone.findings) == list_all(variant.findings), name
        assert list_all(alone.silenced_findings) == list_all(variant.silenced_findings), name
        for field in dataclasses.fields(alone.architecture):
            shared, own = getattr(variant.architecture, field.name), getattr(alone.architecture, field.name)
            assert list_all(shared) == list_all(own), (name, field.name)
        assert (alone.analysis is None) == (variant.analysis is None)
        if alone.analysis is not None and variant.analysis is not None:
            assert list_all(alone.analysis.system) == list_all(variant.analysis.system), name
            assert alone.analysis == variant.analysis, name


def test_a_variant_takes_over_what_it_does_not_change(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(
        "archgen: 1\n"
        "groups: {g: {components: {a: {outputs: {o: Data}}, b: {inputs: {i: a.o}}, c: {inputs: {i: a.o}}}}}\n"
        "types: {Data: {message: std_msgs/msg/String}}\n"
        "nodes: {a: {implements: a}, b: {implements: b}}\n"
        "variants: {v: {changes: {groups: {g: {components: {b: {title: Other}}}}}}, w: {drop: [nodes.b]}}\n",
        encoding="utf-8",
    )
    checked = pipeline.check_project(file)
    for variant, changed in (("v", {"g.b"}), ("w", set())):
        own, shared = checked.variants[variant].architecture, checked.architecture
        assert {name for name in own.components if own.components[name] is not shared.components[name]} == changed
    assert checked.variants["v"].architecture.nodes["a"] is checked.architecture.nodes["a"]
    assert checked.variants["v"].architecture.topics["/g/a/o"] is not None
