"""Figure 5 as rules beside `flatten`: on random robots both leave the same leaves, ports and connections.

Exactly this is compared: the leaves by where they stood, what their ports carry and come from, and all else that a leaf
says of itself. The rules call a leaf after its whole path, the pass after the shortest end of it that is unique. What a
composed component says for its leaves (owner, status, tags, parameters of its own, nodes) the pass alone hands down: the
robots of the first test say none of it, and the last test holds the difference.
"""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen.checking.checked_packing import pack_checked_project
from archgen.link.port_sources import OpenShells
from archgen.passes.flattening import name_flat_components
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.patterns.pattern_registry import find_known_passes
from archgen.pipeline import CheckedProject, check_project, transform_project
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import judge_shipped
from tests.passes.patterns.random_robots import make_robot
from tests.passes.random_projects import RandomProject
from tests.property_sizes import list_seeds, try_some
from tests.running import ROOT

CONNECTIONS = ("connect_components", "connect_ports", "connect_types", "resolve_instances")


def _run(checked: CheckedProject, *names: str) -> CheckedProject:
    made = transform_project(checked, names, find_known_passes(checked.loaded_project).passes)
    assert made.transformed is not None
    assert [
        each.message for each in made.transformed.findings if each.rule in {"wrong-pass", "unknown-reference"}
    ] == []
    return made


def _pack(checked: CheckedProject) -> dict[str, object]:
    packed = pack_checked_project(checked)
    data = yaml.safe_load(write_yaml(packed.data, packed.comments))
    assert isinstance(data, dict)
    return data


def _drop_keys(data: object, *keys: str) -> object:
    if isinstance(data, dict):
        return {key: _drop_keys(value, *keys) for key, value in data.items() if key not in keys}
    return [_drop_keys(item, *keys) for item in data] if isinstance(data, list) else data


def _write_out(checked: CheckedProject, folder: Path, *keys: str) -> CheckedProject:
    """Give a project with each connection written, without what could be joined in several ways, and without some keys."""
    data = _drop_keys(_pack(_run(checked, *CONNECTIONS)), "autoconnect", *keys)
    folder.mkdir()
    (folder / "archgen.yaml").write_text(yaml.safe_dump(data, sort_keys=False), encoding="utf-8")
    return check_project(folder)


def _join_path(path: str) -> str:
    group, _, rest = path.partition(".")
    return f"{group}.{rest.replace('.', '_')}"


def _name_leaves(checked: CheckedProject) -> dict[str, str]:
    """Return what `flatten` calls each leaf, by what the rules call it."""
    linked = LinkedTree(checked.loaded_project, checked.merged_table, checked.architecture.interfaces)
    outline = linked.outline
    shells = OpenShells(outline, linked.joined_sources)
    open_shells = [each.id for group in outline.groups for each in shells.list_in_group(group)]
    leaves = [*outline.components, *open_shells]
    names = name_flat_components(leaves, [*outline.components, *outline.shells], ())
    return {_join_path(leaf): name for leaf, name in names.items()}


def _list_leaves(checked: CheckedProject, names: dict[str, str]) -> dict[str, object]:
    """Return what each component of a flat project says, with all connected components by their names in `names`."""

    def rename(reference: str) -> str:
        component, _, port = reference.rpartition(".")
        return f"{names[component]}.{port}"

    leaves: dict[str, object] = {}
    for component in checked.architecture.components.values():
        edges = [each for each in checked.architecture.edges if each.input.rpartition(".")[0] == component.id]
        leaves[names[component.id]] = (
            sorted((name, port.type, port.medium, port.external) for name, port in component.outputs.items()),
            sorted((name, port.medium, port.external) for name, port in component.inputs.items()),
            sorted((each.input.rpartition(".")[2], rename(each.output)) for each in edges),
            component.functionality,
            sorted(component.tags),
        )
    return leaves


def _compare(checked: CheckedProject) -> int:
    """Flatten in both ways; return how many components are gone."""
    names = _name_leaves(checked)
    by_rules, by_pass = _run(checked, "rules.flatten"), _run(checked, "flatten")
    assert set(by_rules.architecture.components) == set(names)
    assert _list_leaves(by_rules, names) == _list_leaves(by_pass, {name: name for name in names.values()})
    packed = _pack(by_rules)
    assert "hints" not in str(packed)
    assert _pack(_run(by_rules, "rules.flatten")) == packed
    return str(_pack(checked)).count("'components'") - str(packed).count("'components'")


@pytest.mark.slow
def test_rules_leave_the_leaves_and_connections_of_the_pass(tmp_path: Path) -> None:
    gone = [
        _compare(_write_out(check_project(make_robot(seed, tmp_path / f"{seed}")), tmp_path / f"w{seed}"))
        for seed in range(12)
    ]
    assert sum(gone) > 20


@pytest.mark.parametrize("seed", list_seeds(20))
def test_rules_and_pass_agree_on_drawn_projects(seed: int, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(RandomProject(seed).text, encoding="utf-8")
    _compare(_write_out(check_project(tmp_path), tmp_path / "written", "node"))


@pytest.mark.parametrize("example", try_some(["first_robot", "drone", "bringup"]))
def test_rules_and_pass_agree_on_examples(example: str, tmp_path: Path) -> None:
    keys = ("node", "nodes", "parameters", "frames", "chains", "use_cases", "views", "policies", "scenarios")
    _compare(_write_out(judge_shipped(ROOT / "examples" / example), tmp_path / "written", *keys))


LOOPS = """\
archgen: 1
groups:
  g:
    components:
      s: {outputs: {p: {type: Pose}}, inputs: {back: {from: [box.out, box.through]}}}
      box:
        inputs: {q: {from: [s.p, box.out]}, open: {from: s.p}, seen: {external: The room, type: Pose}}
        outputs: {out: {from: [last.z, first.z]}, through: {from: self.q}, never: {type: Pose}}
        components:
          first: {inputs: {q: {from: [self.q, first.z]}, seen: {from: self.seen}}, outputs: {z: {type: Pose}}}
          last: {inputs: {q: {from: [first.z, last.z]}}, outputs: {z: {type: Pose}}}
      ear: {inputs: {never: {from: box.never}}}
types: {Pose: geometry_msgs/msg/Pose}
"""


def test_loops_and_open_ports_come_out_alike(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(LOOPS, encoding="utf-8")
    checked = check_project(tmp_path)
    assert [each.message for each in checked.findings if each.rule == "unknown-reference"] == []
    assert _compare(checked) == 1


SAID_AROUND = """\
archgen: 1
groups:
  g:
    components:
      box:
        status: planned
        tags: [moving]
        parameters: {side: left}
        components:
          motor: {outputs: {z: {type: Pose}}, parameters: {joint: "$(self.side)_joint"}}
          watch: {inputs: {z: {from: motor.z}}}
types: {Pose: geometry_msgs/msg/Pose}
chains: {c: {through: [box.motor, box.watch]}}
"""


def test_only_the_pass_hands_down_what_is_said_around_and_rewrites_other_sections(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(SAID_AROUND, encoding="utf-8")
    checked = check_project(tmp_path)
    by_pass = _run(checked, "flatten").architecture
    motor = by_pass.components["g.motor"]
    assert (str(motor.status), motor.tags, [each.value for each in motor.parameters.values()]) == (
        "planned",
        ("moving",),
        ["left_joint"],
    )
    assert [each.id for each in by_pass.chains.values()] == ["c"]
    by_rules = transform_project(checked, ("rules.flatten",), find_known_passes(checked.loaded_project).passes)
    motor = by_rules.architecture.components["g.box_motor"]
    assert (motor.status, motor.tags) == (None, ())
    # What is not rewritten is told, and no such result is written without being asked for.
    assert sorted(each.message for each in by_rules.findings if str(each.severity) == "error") == [
        "`self.side` names a parameter of the component around `g.box_motor`, but there is none",
        "no component or output named `box.motor`",
        "no component or output named `box.watch`",
    ]
