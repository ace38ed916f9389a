"""Fill in the templates of `start/`, which hold the layout of everything that a new project begins with."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from typing import Any

import jinja2
import yaml as pyyaml

from archgen import resources
from archgen.diagnostics import Severity, make_visible
from archgen.emit.markdown.comment_sentences import escape_markdown
from archgen.start.start_answers import EXAMPLE_GROUPS, GroupAnswer, StartAnswers
from archgen.syntax import yaml_writer
from archgen.syntax.file_patterns import YAML_ENDINGS

_PLAIN_PATH_PATTERN = re.compile(r"[A-Za-z0-9._/-]+\Z")
"""Folders without characters that have a meaning in a workflow's path filter."""
_RUN_GROUP = "${{ github.event_name == 'pull_request' && github.ref || github.run_id }}"
PORT_HINTS = {
    "inputs": "  # where the data comes from: group.component.output",
    "outputs": "  # what it gives: a conceptual type each",
}


@cache
def _make_environment() -> jinja2.Environment:
    environment = jinja2.Environment(  # noqa: S701 - YAML and Markdown, each escaped by its filter
        loader=jinja2.FileSystemLoader(resources.resource_path("start")),
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
    environment.filters |= {
        "yaml": yaml_writer.format_scalar,
        "flow": yaml_writer.format_flow,
        "markdown": escape_markdown,
    }
    environment.globals |= {"repository": resources.REPOSITORY, "home_url": resources.HOME_URL}
    return environment


def fill_template(name: str, **values: object) -> bytes:
    """Return one template's text."""
    return _make_environment().get_template(name).render(values).encode()


def read_plain_file(name: str) -> bytes:
    """Return a file that is used as it is."""
    return resources.resource_path("start", *name.split("/")).read_bytes()


def fill_project_file(answers: StartAnswers) -> bytes:
    """Return the beginning of archgen.yaml."""
    return fill_template(
        "archgen.yaml.j2",
        id=answers.id,
        title=answers.title,
        distro=answers.distro,
        partners=answers.partners,
        foreign=_choose_foreign(answers),
    )


def _choose_foreign(answers: StartAnswers) -> Severity:
    """Return how serious it is to edit what belongs to others: who is in a team, or stands for nobody, cannot be told."""
    names_people = all(partner.reviewers and "/" not in partner.reviewers for partner in answers.partners)
    return Severity.ERROR if names_people else Severity.WARNING


def fill_agreements(partner_title: str, *, has_schema: bool = True) -> bytes:
    """Return the file in which a partner writes what it agrees on, without any agreement yet."""
    return fill_template(
        "agreements.yaml.j2", title=make_visible(" ".join(partner_title.split())), has_schema=has_schema
    )


def fill_readme(answers: StartAnswers) -> bytes:
    """Return the project's README."""
    return fill_template("README.md.j2", title=answers.title, forge=answers.forge, partners=answers.partners)


def fill_workflow(folder: str, *, publishes: bool = True) -> bytes:
    """Return GitHub's workflow for a project in a folder of the repository (empty: the repository itself).

    Only one of a repository `publishes`: there is one site.
    """
    # Any YAML elsewhere may be a library of the project one day.
    paths = [f"{folder}/**", *(f"**/*{ending}" for ending in YAML_ENDINGS)] if _PLAIN_PATH_PATTERN.match(folder) else []
    # A folder's name must not become an expression of GitHub; below, not a variable of GitLab.
    inert_folder = folder.replace("${{", "${{ '${{' }}")
    return fill_template(
        "github.yml.j2",
        folder=inert_folder,
        paths=paths,
        # Two projects of a repository must not cancel each other's runs.
        workflow_name=f"Architecture of {inert_folder}" if folder else "Architecture",
        group="-".join(filter(None, ("architecture", inert_folder, _RUN_GROUP))),
        key=f"diff/{make_project_slug(folder)}",
        publishes=publishes,
    )


def fill_nightly_workflow(folder: str) -> bytes:
    """Return GitHub's workflow that holds open pull requests against each other."""
    inert_folder = folder.replace("${{", "${{ '${{' }}")
    return fill_template(
        "github_nightly.yml.j2",
        folder=inert_folder,
        workflow_name=f"Open pull requests of {inert_folder}" if folder else "Open pull requests",
        group="-".join(filter(None, ("requests", inert_folder))),
        key="/".join(filter(None, ("requests", make_project_slug(folder)))),
    )


def make_project_slug(folder: str) -> str:
    """Return a folder's path as one word of letters, digits, `_`, `.` and `-`."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", folder).strip("-.")


def fill_pipeline(folder: str) -> bytes:
    """Return GitLab's pipeline."""
    return fill_template("gitlab.yml.j2", folder=folder.replace("$", "$$") or ".")


def fill_group_files(answers: StartAnswers) -> dict[str, bytes]:
    """Return a file for each group, with a first component or two: a flow from a sensor to an actuator."""
    has_own_groups = tuple(group.id for group in answers.groups) != EXAMPLE_GROUPS
    examples = pyyaml.safe_load(read_plain_file("examples.yaml"))["stubs" if has_own_groups else "robot"]
    files, source = dict[str, bytes](), ""
    for number, group in enumerate(answers.groups):
        components = []
        for kind in _example_kinds(number, len(answers.groups)):
            component = _example_component(examples[kind], group, kind, source)
            source = f"{group.id}.{component['id']}.{next(iter(component['body']['outputs']))}"
            components.append(component)
        components[0]["first"] = number == 0
        values = {"id": group.id, "title": group.title, "owner": group.owner}
        files[f"groups/{group.id}.yaml"] = fill_template(
            "group.yaml.j2", **values, components=components, hints=PORT_HINTS
        )
    return files


def _example_kinds(number: int, count: int) -> list[str]:
    """Return the kinds of example components in a group: sensor first, actuator last, steps between."""
    kinds = ["sensor"] if number == 0 else []
    if (count < 3 and number == count - 1) or 0 < number < count - 1:  # noqa: PLR2004 - first, middle, last
        kinds.append("step")
    return [*kinds, "actuator"] if number == count - 1 else kinds


def _example_component(example: Mapping[str, Any], group: GroupAnswer, kind: str, source: str) -> dict[str, Any]:
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
