"""Fill in the templates of `start/`, which hold the layout of everything that a new project begins with."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from functools import cache
from typing import Any

import jinja2
import yaml as pyyaml

from archgen import resources
from archgen.emit import yaml
from archgen.emit.text.filters import markdown
from archgen.start.answers import ROBOT, Answers, Group

_PLAIN_PATH = re.compile(r"[A-Za-z0-9._/-]+\Z")
"""Folders without characters that have a meaning in a workflow's path filter."""
SCHEMA = ".archgen/archgen.schema.json"
HINTS = {
    "inputs": "                      # where the data comes from: group.component.output",
    "outputs": "                     # what it gives: a conceptual type each",
}


@cache
def _environment() -> jinja2.Environment:
    made = jinja2.Environment(  # noqa: S701 - YAML and Markdown, each escaped by its filter
        loader=jinja2.FileSystemLoader(resources.path("start")),
        undefined=jinja2.StrictUndefined,
        keep_trailing_newline=True,
        trim_blocks=True,
        lstrip_blocks=True,
        # Braces would clash with YAML's flow mappings and with GitHub's own `${{ }}`.
        variable_start_string="[[",
        variable_end_string="]]",
        block_start_string="[%",
        block_end_string="%]",
        comment_start_string="[#",
        comment_end_string="#]",
    )
    made.filters |= {"yaml": yaml.scalar, "flow": yaml.flow, "markdown": markdown, "entry": _entry}
    return made


def fill(name: str, **values: object) -> bytes:
    """Return one template's text."""
    return _environment().get_template(name).render(values).encode()


def plain(name: str) -> bytes:
    """Return a file that is used as it is."""
    return resources.path("start", *name.split("/")).read_bytes()


def project(
    answers: Answers, requirements: Mapping[str, object], types: Mapping[str, object], *, sources: bool
) -> bytes:
    """Return archgen.yaml; with `sources` it names its slices, since there are other YAML files beside them."""
    return fill(
        "archgen.yaml.j2",
        id=answers.id,
        title=answers.title,
        distro=answers.distro,
        partners=answers.partners,
        requirements=requirements,
        types=types,
        sources=sources,
    )


def readme(answers: Answers) -> bytes:
    """Return the project's README."""
    return fill("README.md.j2", title=answers.title, forge=answers.forge, partners=answers.partners)


def workflow(folder: str) -> bytes:
    """Return GitHub's workflow for a project in a folder of the repository (empty: the repository itself)."""
    paths = [f"{folder}/**"] if _PLAIN_PATH.match(folder) else []
    # A folder's name must not become an expression of GitHub; below, not a variable of GitLab.
    return fill("github.yml.j2", folder=folder.replace("${{", "${{ '${{' }}"), paths=paths)


def pipeline(folder: str) -> bytes:
    """Return GitLab's pipeline."""
    return fill("gitlab.yml.j2", folder=folder.replace("$", "$$") or ".")


def groups(answers: Answers) -> dict[str, bytes]:
    """Return a file for each group, with a first component or two: a flow from a sensor to an actuator."""
    named = tuple(group.id for group in answers.groups) != ROBOT
    examples = pyyaml.safe_load(plain("examples.yaml"))["stubs" if named else "robot"]
    files, source = dict[str, bytes](), ""
    for number, group in enumerate(answers.groups):
        made = []
        for kind in _kinds(number, len(answers.groups)):
            component = _component(examples[kind], group, kind, source)
            source = f"{group.id}.{component['id']}.{next(iter(component['body']['outputs']))}"
            made.append(component)
        made[0]["first"] = number == 0
        values = {"id": group.id, "title": group.title, "owner": group.owner}
        files[f"groups/{group.id}.yaml"] = fill("group.yaml.j2", **values, components=made, hints=HINTS)
    return files


def _kinds(number: int, count: int) -> list[str]:
    """Return the kinds of example components in a group: sensor first, actuator last, steps between."""
    kinds = ["sensor"] if number == 0 else []
    if (count < 3 and number == count - 1) or 0 < number < count - 1:  # noqa: PLR2004 - first, middle, last
        kinds.append("step")
    return [*kinds, "actuator"] if number == count - 1 else kinds


def _component(example: Mapping[str, Any], group: Group, kind: str, source: str) -> dict[str, Any]:
    body = {**example["body"]}
    if source:
        body["inputs"] = {source.rpartition(".")[2]: source}
    node = {**example["node"]}
    # An id has at most 64 characters (`ids.LONGEST`).
    name = node.pop("id", f"{group.id}_{kind}"[:64].strip("_"))
    return {
        "id": example["id"],
        "body": body,
        "first": False,
        "node": {"id": name, "body": {"implements": f"{group.id}.{example['id']}", **node}},
    }


def _entry(value: object) -> str:
    """Return what follows a key's colon: nothing for what is not known yet."""
    return f" {yaml.flow(value)}" if value is not None else ""


def schema() -> bytes:
    """Return the JSON Schema for editors, more compact than it ships."""
    data = json.loads(resources.path("schemas", "archgen.schema.json").read_bytes())
    return (json.dumps(data, ensure_ascii=False, indent=1) + "\n").encode()
