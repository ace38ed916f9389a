"""Words that options take: those of the model, which are those of the language's schema."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, get_args

import click
import pytest

from archgen import resources
from archgen.cli import main
from archgen.diagnostics.diagnostic import Severity
from archgen.history import HistoryInterval
from archgen.link.timing_overrides import _BEHAVIOUR_WORDS
from archgen.model.component import ComponentRole, DiagramDirection
from archgen.model.declared_timing import ActivityBehaviour
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.model.node import NodeKind, NodeStatus
from archgen.views.pages.report_outline import DetailLevel
from tests.cli.conftest import Run


def choices(words: str, option: str) -> set[str]:
    command: click.Command = main
    for word in words.split():
        assert isinstance(command, click.Group)
        found = command.get_command(click.Context(command), word)
        assert found is not None
        command = found
    (parameter,) = (p for p in command.params if option in p.opts)
    assert isinstance(parameter.type, click.Choice)
    return set(parameter.type.choices)


@pytest.mark.parametrize(
    ("verb", "option", "words"),
    [
        ("init", "--distro", KNOWN_DISTROS),
        ("new component", "--role", get_args(ComponentRole)),
        ("new node", "--status", get_args(NodeStatus)),
        ("stats", "--by", get_args(HistoryInterval)),
        ("report", "--level", get_args(DetailLevel)),
    ],
)
def test_an_option_takes_the_words_of_the_model(verb: str, option: str, words: tuple[str, ...]) -> None:
    assert choices(verb, option) == set(words)


@pytest.mark.parametrize(
    ("definition", "words"),
    [
        ("role", get_args(ComponentRole)),
        ("node_status", get_args(NodeStatus)),
        ("node_kind_item", get_args(NodeKind)),
        ("behaviour", get_args(ActivityBehaviour)),
        ("behaviour", _BEHAVIOUR_WORDS),
        ("direction", get_args(DiagramDirection)),
        ("level", get_args(DetailLevel)),
        ("severity", tuple(Severity)),
    ],
)
def test_the_schema_takes_the_words_of_the_model(definition: str, words: tuple[str, ...]) -> None:
    schema: dict[str, Any] = json.loads(
        resources.resource_path("schemas", "archgen.schema.json").read_text(encoding="utf-8")
    )
    assert set(schema["$defs"][definition]["enum"]) - {None} == set(words)


def test_a_project_starts_with_any_distribution_whose_interfaces_are_held(run: Run, tmp_path: Path) -> None:
    for distro in KNOWN_DISTROS:
        ran = run("init", tmp_path / distro, "--yes", "--distro", distro)
        assert ran.status == 0, ran.err
        assert run("check", tmp_path / distro).status == 0
