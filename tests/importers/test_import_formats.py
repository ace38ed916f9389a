"""Formats are told by plug-ins: those that ship in their order, then those of installed packages, refused where they say too little."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import installed_plugins
from archgen.importers.import_formats import guess_format, list_import_formats
from archgen.installed_plugins import IMPORTERS, PluginRefusedError
from tests.installed_packages import installed_in, write_package

PLUGIN = {"api": 1, "summary": "a toy", "endings": (".toy",), "reader": "archgen_toy:read_toy"}


@pytest.fixture(autouse=True)
def shipped(monkeypatch: pytest.MonkeyPatch) -> None:
    late, early = {**PLUGIN, "rank": 2, "endings": (".late",)}, {**PLUGIN, "rank": 1, "endings": (".early",)}
    plugins = {"a": {"importers": {"late": late}}, "b": {"importers": {"early": early}, "readers": {"tables": "x:y"}}}
    monkeypatch.setattr(installed_plugins, "list_shipped_plugins", lambda: plugins)


def install(folder: Path, facts: object, name: str = "toy") -> None:
    code = f"def read_toy(files):\n    return len(files)\n\n\nPLUGIN = {facts!r}\n"
    write_package(folder, "archgen_toy", {IMPORTERS: {name: "archgen_toy:PLUGIN"}}, code)


def test_formats_of_others_come_behind_those_that_ship(tmp_path: Path) -> None:
    install(tmp_path, PLUGIN)
    with installed_in(tmp_path):
        formats = list_import_formats()
        assert [(known.name, known.origin) for known in formats.values()] == [
            ("early", ""),
            ("late", ""),
            ("toy", "archgen-toy 1.0"),
        ]
        assert guess_format(Path("a.TOY"), formats) == formats["toy"]
        assert guess_format(Path("a.txt"), formats) is None
        assert formats["toy"].load_reader()([Path("a.toy")]) == 1


@pytest.mark.parametrize(
    ("facts", "name", "problem"),
    [
        ({"api": 1, "summary": "a toy"}, "toy", "it does not say endings, reader"),
        ({**PLUGIN, "ending": ".toy"}, "toy", "an importer has no ending"),
        (PLUGIN, "late", "archgen has a format of this name already"),
    ],
)
def test_what_is_no_format_is_refused(facts: object, name: str, problem: str, tmp_path: Path) -> None:
    install(tmp_path, facts, name)
    with installed_in(tmp_path), pytest.raises(PluginRefusedError) as refused:
        list_import_formats()
    assert str(refused.value) == f"the importer `{name}` of archgen-toy 1.0 cannot be used: {problem}"


def test_two_packages_do_not_bring_one_format(tmp_path: Path) -> None:
    install(tmp_path, PLUGIN)
    write_package(tmp_path, "other_toy", {IMPORTERS: {"toy": "other_toy:PLUGIN"}}, f"PLUGIN = {PLUGIN!r}\n")
    with installed_in(tmp_path), pytest.raises(PluginRefusedError, match=r"archgen-toy 1\.0 has a format of this name"):
        list_import_formats()


def test_a_reader_that_is_no_function_of_its_module_is_said(tmp_path: Path) -> None:
    install(tmp_path, {**PLUGIN, "reader": "archgen_toy:read_games"})
    with installed_in(tmp_path), pytest.raises(PluginRefusedError, match="has no attribute 'read_games'"):
        list_import_formats()["toy"].load_reader()
