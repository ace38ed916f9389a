"""Plug-ins are tried by verbs, too."""

from tests.cli.conftest import run

__all__ = ["run"]
