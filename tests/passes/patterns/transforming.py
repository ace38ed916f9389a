"""Projects as texts that rules rewrite, and what comes of them."""

from __future__ import annotations

import textwrap
from pathlib import Path

import yaml

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.passes.pass_shape import STATES, PassWork
from archgen.passes.patterns.expressions import PatternPass
from archgen.passes.patterns.pattern_registry import ReadPass, read_pass
from archgen.passes.patterns.rule_running import run_rules
from archgen.passes.project_tree import ProjectTree
from archgen.pipeline import check_project
from archgen.syntax.yaml_tree import node_to_data


def pass_of(rules: str) -> PatternPass:
    """Read rules that are meant to be right."""
    tried = read("title: Tried here\nrules:\n" + textwrap.indent(textwrap.dedent(rules).strip("\n"), "  "))
    assert tried.read_pass is not None, [f"{each.span}: {each.message}" for each in tried.diagnostics]
    return tried.read_pass


def read(text: str) -> ReadPass:
    """Read the text of a pass file."""
    return read_pass("tried", "passes/tried.yaml", text, tuple(STATES))


def work_of(project: str, folder: Path) -> PassWork:
    """Give what a pass works with in a project of one file."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(textwrap.dedent(project), encoding="utf-8")
    checked = check_project(folder)
    tree = ProjectTree(checked.merged_table)
    tree.maker = "tried"
    return PassWork(checked.loaded_project, tree, checked.architecture.interfaces)


def tree_of(project: str, folder: Path) -> ProjectTree:
    """Give the tree of a project of one file."""
    return work_of(project, folder).tree


def transform(project: str, rules: str, folder: Path) -> tuple[dict[str, object], tuple[Diagnostic, ...]]:
    """Run rules upon a project of one file; give it as plain data, with what was found."""
    work = work_of(project, folder)
    findings = run_rules(pass_of(rules), work)
    data = node_to_data(work.tree.root)
    assert isinstance(data, dict)
    return data, findings


def said(project: str, rules: str, folder: Path) -> list[str]:
    """Run rules upon a project; give what was found, with the line of the pass file."""
    _, findings = transform(project, rules, folder)
    return [f"{each.span.line}: {each.message}" for each in findings]


def data_of(text: str) -> object:
    """Read YAML as plain data."""
    return yaml.safe_load(textwrap.dedent(text))
