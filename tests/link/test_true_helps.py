"""Helps of findings between files and libraries: what they say is what leads to a sound project."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project

LIBRARY = "archgen: 1\nlibraries: {ros: builtin}\nros: {distro: jazzy}\n"


def list_helps(folder: Path, **texts: str) -> list[tuple[str, str | None]]:
    for name, text in texts.items():
        (folder / f"{name}.yaml").write_text(text, encoding="utf-8")
    findings = check_project(folder).findings
    return [(d.message, d.help) for d in findings if d.severity == "error" or d.rule == "unset-parameter"]


def test_a_type_that_a_library_lacks_is_looked_up_there(tmp_path: Path) -> None:
    text = f"{LIBRARY}groups: {{a: {{components: {{lidar: {{is: ros.lidar_2d}}}}}}}}\n"
    assert list_helps(tmp_path, archgen=text) == [
        (
            "no component type named `ros.lidar_2d`",
            "`archgen list --of component_types --library ros` lists those that it has",
        )
    ]


def test_the_outputs_of_a_component_are_listed_where_none_is_like_the_one_asked_for(tmp_path: Path) -> None:
    text = f"{LIBRARY}groups: {{a: {{components: {{loc: {{is: ros.amcl}}, c: {{inputs: {{p: a.loc.pose}}}}}}}}}}\n"
    assert list_helps(tmp_path, archgen=text)[0] == (
        "no output named `a.loc.pose`",
        "there are `a.loc.amcl_pose`, `a.loc.particle_cloud` and `a.loc.tf`",
    )


@pytest.mark.parametrize("parameters", ["", ", parameters: {serial_port: /dev/ttyACM0}"])
def test_a_parameter_of_an_instance_is_written_at_it(tmp_path: Path, parameters: str) -> None:
    types = f"component_types: {{robot: {{components: {{lidar: {{is: ros.urg_node{parameters}}}}}}}}}\n"
    helps = list_helps(tmp_path, archgen=f"{LIBRARY}{types}groups: {{a: {{components: {{r: {{is: robot}}}}}}}}\n")
    asked = "write it at the component: `parameters: {serial_port: ...}`"
    assert [help_line for _, help_line in helps] == ([] if parameters else [asked])


def test_two_nodes_of_one_id_are_one_finding(tmp_path: Path) -> None:
    first = "groups: {a: {components: {c: C, d: D}}}\nnodes: {lidar: {implements: a.c, package: p, executable: e}}\n"
    second = "nodes: {lidar: {implements: a.d, package: q, executable: f}}\n"
    assert list_helps(tmp_path, archgen="archgen: 1\n", first=first, second=second) == [
        (
            "two places describe a node `lidar`",
            "rename one of them; if it is one node, each value stands in one place",
        )
    ]
    # One value too many is a slip in one node.
    helps = list_helps(tmp_path, second="nodes: {lidar: {package: q, host: pc}}\nhosts: {pc: Computer}\n")
    assert [message for message, _ in helps] == ["`package` of `lidar` is written in two places"]
