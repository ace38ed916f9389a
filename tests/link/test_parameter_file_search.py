"""Which of the parameter files that nodes name are missed."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project


def findings_of(folder: Path, node: str, files: tuple[str, ...], project_file: str = "archgen.yaml") -> list[str]:
    for name in files:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("p: 1\n", encoding="utf-8")
    # The rule is off where nobody asks for it.
    text = f"archgen: 1\nrules: {{missing-parameter-file: warning}}\ngroups: {{g: {{components: {{c: C}}}}}}\nnodes: {{n: {{implements: c, {node}}}}}\n"
    (folder / project_file).write_text(text, encoding="utf-8")
    path = folder if project_file == "archgen.yaml" else folder / project_file
    found = check_project(path).findings
    return [f"{d.span.line}:{d.span.column} {d.message}" for d in found if d.rule == "missing-parameter-file"]


@pytest.mark.parametrize(
    ("node", "files"),
    [
        ("parameter_files: [config/a.yaml]", ("config/a.yaml",)),
        ("parameter_files: [./config/a.yaml]", ("config/a.yaml",)),
        ("package: drv, parameter_files: [config/a.yaml]", ("src/robot/drv/config/a.yaml",)),
        # Files of a package that is not in the project.
        ("package: drv, parameter_files: [config/a.yaml]", ()),
        ("package: drv, parameter_files: [config/a.yaml]", (".hidden/drv/x.yaml", "build/drv/x.yaml")),
        ("parameter_files: [/etc/robot/a.yaml, ~/a.yaml, '$(find-pkg-share drv)/a.yaml', 'package://drv/a.yaml']", ()),
        ("package: drv, parameter_files: []", ()),
    ],
)
def test_what_is_there_or_may_lie_elsewhere_is_not_missed(tmp_path: Path, node: str, files: tuple[str, ...]) -> None:
    assert findings_of(tmp_path, node, files) == []


@pytest.mark.parametrize(
    ("node", "files"),
    [
        ("parameter_files: [config/nix.yaml]", ()),
        ("parameter_files: [config/nix.yaml]", ("config/a.yaml",)),
        ("package: drv, parameter_files: [config/nix.yaml]", ("config/a.yaml",)),
        ("package: drv, parameter_files: [config/nix.yaml]", ("src/drv/package.xml",)),
        ("parameter_files: [config]", ("config/a.yaml",)),
    ],
)
def test_what_the_project_should_hold_is_missed(tmp_path: Path, node: str, files: tuple[str, ...]) -> None:
    name = "config/nix.yaml" if "nix" in node else "config"
    column = len("nodes: {n: {implements: c, ") + node.index("[") + 2
    assert findings_of(tmp_path, node, files) == [f"4:{column} there is no file `{name}`"]


def test_nothing_outside_is_looked_at(tmp_path: Path) -> None:
    (tmp_path / "outside.yaml").write_text("p: 1\n", encoding="utf-8")
    folder = tmp_path / "robot"
    folder.mkdir()
    (folder / "link.yaml").symlink_to(tmp_path / "outside.yaml")
    node = "parameter_files: [../outside.yaml, ../absent.yaml, link.yaml]"
    assert [line.partition(" ")[2] for line in findings_of(folder, node, ())] == ["there is no file `link.yaml`"]


def test_a_project_of_one_file_names_files_that_lie_elsewhere(tmp_path: Path) -> None:
    assert findings_of(tmp_path, "parameter_files: [config/nix.yaml]", (), "packed.yaml") == []
