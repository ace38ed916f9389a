"""Packages with plug-ins, as an installer leaves them in a folder that archgen looks into."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest

from archgen import installed_plugins
from archgen.cache import program_stamp
from archgen.checking import all_rules
from archgen.findings import plugged_rules

_REMEMBERED = (
    installed_plugins._scan_folders,  # noqa: SLF001 - what a process finds once is forgotten between tests
    installed_plugins._list_path_file_folders,  # noqa: SLF001 - the same
    plugged_rules.load_plugged_rules,
    all_rules.index_all_rules,
    program_stamp.stamp_program,
)


def write_package(folder: Path, name: str, entries: Mapping[str, Mapping[str, str]], code: str) -> None:
    """Put a package of one module into a folder: `entries` are its entry points by group and name."""
    about = folder / f"{name}-1.0.dist-info"
    about.mkdir(parents=True, exist_ok=True)
    groups = (
        f"[{group}]\n" + "".join(f"{key} = {target}\n" for key, target in each.items())
        for group, each in entries.items()
    )
    (about / "entry_points.txt").write_text("\n".join(groups), encoding="utf-8")
    (folder / f"{name}.py").write_text(code, encoding="utf-8")


@contextmanager
def installed_in(folder: Path) -> Iterator[None]:
    """Let archgen find the packages of a folder as if an installer had written them there."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(installed_plugins, "list_package_folders", lambda: (str(folder),))
        patch.syspath_prepend(folder)
        _forget_packages()
        try:
            yield
        finally:
            patch.undo()
            _forget_packages()
            _forget_modules(folder)


def _forget_modules(folder: Path) -> None:
    for name, module in list(sys.modules.items()):
        if (getattr(module, "__file__", None) or "").startswith(f"{folder}/"):
            del sys.modules[name]


def _forget_packages() -> None:
    for remembered in _REMEMBERED:
        remembered.cache_clear()
