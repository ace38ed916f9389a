"""The options that verbs share."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

import click
from click.core import ParameterSource

CommandFunction = Callable[..., Any]

_PROJECT_HELP = "The project's folder or single file.  [default: the project around the current folder]"

project_option = click.option("-C", "--project", type=click.Path(path_type=Path), help=_PROJECT_HELP)
"""The project of a verb whose words by position mean something else."""


def project_argument(function: CommandFunction, envvar: str | None = None) -> CommandFunction:
    """Take the project by position or as `-C`, so that `-C` goes with every verb that reads a project.

    `-C` counts where a variable of the environment, `envvar`, names another one.
    """

    @functools.wraps(function)
    def call(*, project: Path | None, named_project: Path | None, **others: object) -> object:
        context = click.get_current_context()
        if context.get_parameter_source("project") is ParameterSource.ENVIRONMENT and named_project is not None:
            project = None
        if project is not None and named_project is not None:
            msg = f"the project is named twice: {project} and -C {named_project}"
            if not os.path.exists(project):  # noqa: PTH110 - Path.exists raises for a name that is too long
                msg = f"{project} is no folder: what stands here is the project, which -C names already"
                options = {"--why", "--select"} & {option for each in context.command.params for option in each.opts}
                msg += f"; elements are named behind {' or '.join(sorted(options))}" if options else ""
            raise click.UsageError(msg)
        return function(project=project or named_project, **others)

    option = click.option(
        "-C", "--project", "named_project", type=click.Path(path_type=Path), help="The same as PROJECT."
    )
    argument = click.argument("project", required=False, type=click.Path(path_type=Path), envvar=envvar)
    return argument(option(call))


select_option = click.option(
    "--select",
    metavar="WORDS",
    help="Show only what a selector names, neighbours grey: `owner:certh`, `sensing+`, `a..b`, `tag:safety -x`.",
)
MEASURED_SLICE = "measured.yaml"
"""The file that `timing --adopt` writes by default."""
VARIANT_KEY = "archgen.variants"
"""Where the variants that a verb is asked for stand in click's context."""


def split_variants(text: str | None) -> tuple[str, ...]:
    """Return the names in a list with commas, each once."""
    return tuple(dict.fromkeys(name for word in (text or "").split(",") if (name := word.strip())))


def _keep_variants(context: click.Context, _parameter: click.Parameter, text: str | None) -> None:
    names = split_variants(text)
    if text is not None and not names:
        raise click.UsageError("`--variant` takes the ids of variants, such as `simulation`")
    context.meta[VARIANT_KEY] = names


def _complete_variants(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the last of several variants of the project around the current folder."""
    from archgen import pipeline
    from archgen.project.project_search import ProjectNotFoundError

    try:
        names = pipeline.list_variant_names(None)
    except ProjectNotFoundError:
        return []
    head, comma, last_name = incomplete.rpartition(",")
    return [f"{head}{comma}{name}" for name in names if name.startswith(last_name)]


variant_option = click.option(
    "--variant",
    metavar="NAMES",
    callback=_keep_variants,
    expose_value=False,
    shell_complete=_complete_variants,
    help="Take the project as it stands in a variant; in several, laid over it in this order: `indoor,simulation`.",
)
"""The variant that a verb looks at: `command_support.check_or_exit` reads it off click's context."""


def find_asked_variants() -> tuple[str, ...]:
    """Return the variants that the verb which runs is asked for; none where it takes the project with all of them."""
    context = click.get_current_context(silent=True)
    return context.meta.get(VARIANT_KEY, ()) if context else ()


level_option = click.option(
    "--level",
    type=click.Choice(["functional", "implementation"]),
    help="Stop at the functional level, or show the ROS side too.  [default: implementation]",
)
keep_going_option = click.option(
    "--keep-going", is_flag=True, help="Make outputs of what is sound although there are errors; they say so."
)
strict_option = click.option("--strict", is_flag=True, help="Count warnings as errors in the exit status.")
revision_option = click.option("--revision", metavar="TEXT", help="Revision to print.  [default: git's last commit]")

history_option = click.option(
    "--history/--no-history",
    default=True,
    help="Show how the project grew month by month, from git.  [default: history]",
)

component_pictures_option = click.option(
    "--component-pictures/--no-component-pictures",
    default=None,
    help="Draw a picture of each component and group for the site, or leave them to its map.  [default: up to 300 components and 200 groups]",
)

trust_option = click.option(
    "--trust",
    metavar="REV",
    help="Run the project's own backends and passes only if `review.backends` and `review.passes` at this git revision name them and their files are as they are there.",
)


def _list_backend_ids(makes: str) -> list[str]:
    """Return the text backends that make this: those that ship, and those of the project around the current folder."""
    from archgen.emit.backend_manifests import CALLED_EMITTERS, find_backends
    from archgen.project.project_search import ProjectNotFoundError, find_project

    try:
        root, _ = find_project(None)
    except ProjectNotFoundError:
        root = Path.cwd()
    backends, _ = find_backends(root)
    return [name for name, backend in backends.items() if backend.emitter in CALLED_EMITTERS and backend.makes == makes]


def complete_backends(makes: str) -> Callable[[click.Context, click.Parameter, str], list[str]]:
    """Return what completes the name of a backend that makes this: documents, a workspace, or a file."""
    return lambda _context, _parameter, incomplete: [
        name for name in _list_backend_ids(makes) if name.startswith(incomplete)
    ]


def backend_argument(makes: str, *, required: bool = True) -> Callable[[CommandFunction], CommandFunction]:
    """Take the name of a backend that makes this; without one that is required, say which there are."""

    def ask(_context: click.Context, _parameter: click.Parameter, name: str | None) -> str | None:
        if name is None and required:
            refuse_missing_backend(makes)
        return name

    return click.argument("name", required=False, callback=ask, shell_complete=complete_backends(makes))


def refuse_missing_backend(makes: str, advice: str = "") -> NoReturn:
    """Say which backends there are, since nobody names one."""
    names = ", ".join(sorted(_list_backend_ids(makes)))
    raise click.UsageError(f"name what to make: {names}; `archgen list --of backends` says what each is{advice}")


def complete_products(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the last of several names of outputs."""
    from archgen.products.product_table import PRODUCTS

    head, comma, last_name = incomplete.rpartition(",")
    names = (*PRODUCTS, *_list_backend_ids("documents"))
    return [f"{head}{comma}{name}" for name in names if name.startswith(last_name)]


def _complete_partners(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete a partner of the project around the current folder."""
    from archgen import pipeline
    from archgen.project.project_search import ProjectNotFoundError

    try:
        partners = pipeline.check_project(None).architecture.partners
    except ProjectNotFoundError:
        return []
    return [name for name in partners if name.startswith(incomplete)]


def partner_option(help_text: str, *, required: bool = False) -> Callable[[CommandFunction], CommandFunction]:
    """Make the option of a verb that is about a partner."""
    return click.option("--partner", metavar="ID", required=required, shell_complete=_complete_partners, help=help_text)


def format_option(*formats: str) -> Callable[[CommandFunction], CommandFunction]:
    """Make the option of a verb that says the same in several formats; the first is the default."""
    return click.option("--format", "form", type=click.Choice(formats), default=formats[0], show_default=True)


document_format_option = format_option("text", "markdown", "json")


def template_option(help_text: str) -> Callable[[CommandFunction], CommandFunction]:
    """Make the option of a verb that writes into a document of the user's."""
    path_type = click.Path(exists=True, dir_okay=False, path_type=Path)
    return click.option("--template", type=path_type, help=help_text)


def file_option(help_text: str) -> Callable[[CommandFunction], CommandFunction]:
    """Make the option `-o` of a verb that writes to standard output where no file is named; `-` names none."""
    return click.option(
        "-o",
        "--output",
        type=click.Path(path_type=Path),
        callback=lambda _context, _parameter, output: None if output == Path("-") else output,
        help=help_text,
    )


def _refuse_dash(context: click.Context, _parameter: click.Parameter, output: Path | None) -> Path | None:
    """Refuse `-`: a folder or a Word file goes to no standard output, and nobody means one that is called so."""
    if output == Path("-"):
        msg = f"`archgen {context.info_name}` cannot write to standard output: name a file or a folder"
        raise click.UsageError(msg)
    return output


def output_option(
    target: str, default: str, *, takes_dash: bool = False
) -> Callable[[CommandFunction], CommandFunction]:
    """Make the option `-o` of a verb that writes. With `takes_dash` the verb writes to standard output for `-`."""
    return click.option(
        "-o",
        "--output",
        type=click.Path(path_type=Path),
        callback=None if takes_dash else _refuse_dash,
        help=f"{target} to write; folders on the way are made.  [default: archgen-out/{default} in the project]",
    )
