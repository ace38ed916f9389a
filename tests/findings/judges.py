"""The judges from outside that findings for servers are held against: Microsoft's SARIF Multitool with OASIS's schema, and
the schema by which Jenkins reads JUnit's files.
"""

from __future__ import annotations

import functools
import json
import os
from pathlib import Path
from typing import Any

import jsonschema_rs
from lxml import etree

from tests.outside_tools import JUDGES_FOLDER, find_judge, run_judge

_MULTITOOL = "@microsoft/sarif-multitool-linux"
_ADVICE = {
    "SARIF2002",  # messages by id: ours hold names
    "SARIF2003",  # from which repository: archgen asks no remote
    "SARIF2006",  # whether the schema's address answers
    "SARIF2009",  # rules called CS2001
    "SARIF2010",  # snippets: the servers have the files
    "SARIF2011",  # the same
}
"""What the Multitool advises, and we do not follow."""


def sarif_schema(text: str) -> list[str]:
    """Give what OASIS's schema says against a document."""
    return [f"{error.instance_path}: {error.message}" for error in _schema().iter_errors(json.loads(text))]


@functools.cache
def _schema() -> jsonschema_rs.Draft202012Validator:
    text = find_judge(f"{_MULTITOOL}/sarif-2.1.0.json").read_text("utf-8-sig")
    return jsonschema_rs.Draft202012Validator(json.loads(text))


def sarif(text: str, folder: Path) -> list[str]:
    """Give what the schema and the Multitool (with the rules of GitHub's code scanning) say. It takes seconds."""
    return sarif_schema(text) + _multitool(text, folder)


def _multitool(text: str, folder: Path) -> list[str]:
    (folder / "judged.sarif").write_text(text, encoding="utf-8")
    words = ("--rule-kind", "Sarif;Ghas", "--level", "Error;Warning;Note", "--quiet", "true", "--log", "ForceOverwrite")
    program = find_judge(f"{_MULTITOOL}/Sarif.Multitool")
    environment = {**os.environ, "DOTNET_SYSTEM_GLOBALIZATION_INVARIANT": "1"}
    command = (program, "validate", "judged.sarif", *words, "--output", "verdict.sarif")
    # It ends with 1 where it found something.
    done = run_judge(*command, statuses=(0, 1), cwd=folder, env=environment)
    verdict = folder / "verdict.sarif"
    assert verdict.exists(), f"the Multitool could not run: {done.stdout}{done.stderr}"
    results: list[dict[str, Any]] = json.loads(verdict.read_text("utf-8-sig"))["runs"][0]["results"]
    return [f"{r['ruleId']}: {r['message']}" for r in results if r["ruleId"] not in _ADVICE]


def junit(text: str) -> list[str]:
    """Give what Jenkins' schema says against a document."""
    schema = etree.XMLSchema(etree.parse(JUDGES_FOLDER / "junit-10.xsd"))
    schema.validate(etree.fromstring(text.encode()))
    return str(schema.error_log).splitlines()
