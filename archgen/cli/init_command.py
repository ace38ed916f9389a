"""`archgen init`: start a project, from answers or from a spreadsheet."""

from __future__ import annotations

import os
import shlex
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from archgen.cli import command_support
from archgen.diagnostics import make_visible
from archgen.frozen import replace
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.start import start_answers
from archgen.start.start_answers import ForgeName, GroupAnswer, PartnerAnswer, StartAnswers

if TYPE_CHECKING:
    from collections.abc import Mapping

    from archgen.importers.foreign_import import ImportedTables
    from archgen.pipeline import CheckedProject
    from archgen.start.project_plan import ProjectPlan
    from archgen.start.start_answers import StartAnswers


@click.command("init")
@click.argument("folder", required=False, type=click.Path(file_okay=False, path_type=Path))
@click.option("--title", metavar="TEXT", help="The project's title.  [default: made from the folder's name]")
@click.option(
    "--partner",
    "partners",
    metavar="ID=TITLE",
    multiple=True,
    help="A partner, optionally with `@handle` behind; may be repeated.",
)
@click.option(
    "--group",
    "groups",
    metavar="ID=OWNER",
    multiple=True,
    help="A first group and its owner; may be repeated.  [default: sensing, driving]",
)
@click.option("--distro", type=click.Choice(KNOWN_DISTROS), help="The ROS distribution.  [default: jazzy]")
@click.option(
    "--ci", type=click.Choice(["github", "gitlab", "none"]), help="Whose workflow to write.  [default: github]"
)
@click.option(
    "--from",
    "tables",
    metavar="FILE",
    multiple=True,
    type=click.Path(dir_okay=False, path_type=Path),
    help="Start from tables of components and connections: CSV, .xlsx or .docx; `-` is the standard input. May be "
    "repeated.",
)
@click.option(
    "--map",
    "headings",
    metavar="HEADING=MEANING",
    multiple=True,
    help='What a heading of a table means, such as "Baugruppe=group"; may be repeated.',
)
@click.option(
    "--merge-driver",
    is_flag=True,
    help="Let git merge slices by what they say, in this clone; alone, also in a project that is there already.",
)
@click.option("--empty", is_flag=True, help="Write the groups that are named without components, and no example.")
@click.option("-y", "--yes", is_flag=True, help="Ask nothing: take the defaults for what no flag says.")
def command(  # noqa: PLR0913, PLR0917 - one for each option
    folder: Path | None,
    title: str | None,
    partners: tuple[str, ...],
    groups: tuple[str, ...],
    distro: str | None,
    ci: str | None,
    tables: tuple[Path, ...],
    headings: tuple[str, ...],
    *,
    merge_driver: bool,
    empty: bool,
    yes: bool,
) -> None:
    """Start a project in FOLDER (the current one if left out): a small robot that checks clean, to be changed.

    On a terminal it asks for what no flag says. With the project come the JSON Schema for editors, settings of Visual
    Studio Code, a workflow, CODEOWNERS, .gitattributes, .gitignore and a README. Files that are there are kept, and
    everything is written or nothing. In a git repository that begins above FOLDER, workflow and CODEOWNERS go to its top,
    since nobody reads them elsewhere.
    """
    from archgen.start.start_answers import add_partners

    target = folder or Path()
    if (
        merge_driver
        and not any((title, partners, groups, distro, ci, tables, headings, empty))
        and _has_project(target)
    ):
        _set_up_merge_driver(target)
        return
    _refuse_existing_project(target)
    if tables and groups:
        raise click.UsageError("--from takes the groups from the table: leave out --group")
    if tables and empty:
        raise click.UsageError("--from begins with what the table says: leave out --empty")
    if headings and not tables:
        raise click.UsageError("--map says what the headings of a table mean: it needs --from")
    heading_map = _parse_headings(headings)
    answers = _gather_answers(
        target,
        title=title,
        partners=partners,
        groups=groups,
        distro=distro,
        forge=ci or "github",
        is_empty=empty,
    )
    # What a flag or the tables answer is not asked. The keys are those that `questions` knows.
    flag_values = {
        "title": title,
        "partner": partners or tables,
        "group": groups or tables or empty,
        "distro": distro,
        "ci": ci,
    }
    if not yes and sys.stdin.isatty() and sys.stdout.isatty():
        answers = ask_questions(answers, frozenset(key for key, value in flag_values.items() if value), KNOWN_DISTROS)
    imported = _import_tables(tables, answers.distro, heading_map) if tables else None
    if imported:
        answers = add_partners(answers, imported.data.get("partners", {}))
    _write_project(target, answers, imported)
    if merge_driver:
        _set_up_merge_driver(target)


def _has_project(target: Path) -> bool:
    from archgen.project import PROJECT_FILE

    return os.path.lexists(target / PROJECT_FILE)


def _set_up_merge_driver(target: Path) -> None:
    """Let git merge slices by what they say: say what was written and run, and what is left to do."""
    from archgen.git import GitError, NoRepositoryError
    from archgen.start import project_plan

    with command_support.explain_write_errors():
        for folder in (target, *project_plan.list_outer_libraries(target)):
            path = folder / project_plan.ATTRIBUTES_FILE
            if project_plan.add_attribute(folder):
                command_support.print_written(path, "merge driver; commit it for everybody")
            else:
                click.echo(f"kept {command_support.shorten_path(path)}: it names the merge driver already")
    commands = [project_plan.format_setting(*setting) for setting in project_plan.list_driver_settings().items()]
    try:
        project_plan.configure_git(target)
    except NoRepositoryError:
        click.echo("There is no git repository yet. After `git init`, in this clone and in every other one, call")
    except GitError as error:
        raise click.ClickException(make_visible(str(error))) from None
    else:
        click.echo("ran, for this clone (every other one needs `archgen init --merge-driver` too):")
    for command_line in commands:
        click.echo(f"    {command_line}")
    _set_up_merge_hook(target)


def _set_up_merge_hook(target: Path) -> None:
    """Let git check the project after each merge, and say what there is."""
    from archgen.git import GitError
    from archgen.start.project_plan import install_merge_hook

    try:
        with command_support.explain_write_errors():
            hook = install_merge_hook(target)
    except GitError:  # there is no repository yet, which is said above
        return
    place = make_visible(str(command_support.shorten_path(hook.path)))
    if hook.state == "written":
        click.echo(f"wrote {place} (checks the project after each merge, in this clone)")
    elif hook.state == "kept":
        click.echo(f"kept {place}: it checks the project already")
    else:
        click.echo(f"kept {place}: it is yours, or git looks elsewhere for hooks. To check after each merge, add there")
        for line in hook.lines.splitlines():
            click.echo(f"    {line}")


def _refuse_existing_project(target: Path) -> None:
    """Refuse a folder that has a project already."""
    from archgen.project import PROJECT_FILE

    if _has_project(target):
        raise click.ClickException(f"{target / PROJECT_FILE} is there already; nothing was written")


def _gather_answers(target: Path, **flags: Any) -> StartAnswers:  # noqa: ANN401 - as `gathered` takes them
    from archgen.start import start_answers

    with command_support.explain_wrong_usage(ValueError):
        return start_answers.collect_answers(target.resolve().name, **flags)


def _parse_headings(headings: tuple[str, ...]) -> Mapping[str, str]:

    if not headings:
        return {}
    from archgen.installed_plugins import load_reader

    with command_support.explain_wrong_usage(ValueError):
        heading_map: Mapping[str, str] = load_reader("headings")(headings)
    return heading_map


def _import_tables(tables: tuple[Path, ...], distro: str, heading_map: Mapping[str, str]) -> ImportedTables:
    """Read the tables. Print what was not imported; where nothing could be, end with status 1."""
    from archgen.findings.instance_findings import limit_findings
    from archgen.importers.foreign_import import MAX_OFFICE_BYTES
    from archgen.installed_plugins import load_reader

    imported: ImportedTables = load_reader("tables")(
        [(str(path), command_support.read_input(path, MAX_OFFICE_BYTES)) for path in tables], distro, heading_map
    )
    if imported.diagnostics:
        command_support.print_excerpts(limit_findings(imported.diagnostics), imported.sources, sys.stderr)
    if not imported.data:
        click.echo("Nothing was written.", err=True)
        sys.exit(1)
    for line in imported.summary:
        click.echo(line)
    click.echo()
    return imported


def _write_project(target: Path, answers: StartAnswers, imported: ImportedTables | None) -> None:
    from archgen.emit import new_files
    from archgen.start.project_plan import example_files, imported_files, judge_files, plan_files

    files = imported_files(answers, imported.data) if imported else example_files(answers)
    checked_project = judge_files(files, answers.id)
    project_plan = plan_files(target, answers, files, checked_project)
    _refuse_replacing_slices(project_plan, target, files)
    with command_support.explain_write_errors():
        new_files.write_new_files(project_plan.files, project_plan.repository_folder)
    for path in project_plan.files:
        command_support.print_written(path)
    for path in project_plan.existing_files:
        click.echo(f"kept {command_support.shorten_path(path)}: it is there already")
    _print_outcome(target, checked_project, project_plan)


def _refuse_replacing_slices(project_plan: ProjectPlan, target: Path, files: Mapping[str, bytes]) -> None:
    existing_slices = [
        path for path in project_plan.existing_files if path in {target.resolve() / name for name in files}
    ]
    if existing_slices:
        msg = f"{', '.join(map(str, existing_slices))} would have to be replaced; nothing was written"
        raise click.ClickException(msg)


def _print_outcome(target: Path, checked_project: CheckedProject, project_plan: ProjectPlan) -> None:
    """Print what there is now, and what comes next."""
    from archgen.emit.terminal.findings_text import format_summary
    from archgen.products.editor_schema_marks import SCHEMA_FILE

    architecture = checked_project.architecture
    size = f"{_count_things(len(architecture.groups), 'group')}, {_count_things(len(architecture.components), 'component')}"
    click.echo(
        f"\n{architecture.project.title}: {size}; archgen check says: {format_summary(checked_project.findings)}."
    )
    if checked_project.findings:
        rule_counts = Counter(finding.rule for finding in checked_project.findings)
        sorted_rules = sorted(rule_counts, key=lambda rule: (-rule_counts[rule], rule))
        click.echo(f"By rule: {', '.join(f'{rule_counts[rule]} {rule}' for rule in sorted_rules)}.")
    if project_plan.repository_folder != target.resolve():
        click.echo(f"The repository begins at {project_plan.repository_folder}: what the forge reads stands there.")
    if project_plan.repository_folder / ".gitlab-ci.yml" in project_plan.existing_files:
        click.echo("That .gitlab-ci.yml does not check this project yet: docs/pull_requests.md says which job to add.")
    if any(path.name == "CODEOWNERS" for path in project_plan.existing_files):
        click.echo(
            "That CODEOWNERS does not name this project's files yet: add what `archgen owners --format codeowners` prints."
        )
    if any(
        path.parts[-3:-1] == (".github", "workflows") or path.name == ".gitlab-ci.yml" for path in project_plan.files
    ):
        click.echo("Its workflow names archgen where it is not published yet: README.md says what to write there.")
    if project_plan.reviewers_missing:
        click.echo(
            "No CODEOWNERS yet: give the partners `reviewers`, then archgen owners --format codeowners > CODEOWNERS"
        )
    if target.resolve() / ".gitignore" in project_plan.existing_files:
        click.echo(f"Let .gitignore list {SCHEMA_FILE}, unless it does: `archgen schema` makes it again at any time.")
    change_folder = "" if target.resolve() == Path.cwd() else f"cd {shlex.quote(str(target))}; "
    click.echo(f"Now: {change_folder}archgen check, then archgen build. README.md says how to go on.")


def _count_things(count: int, noun: str) -> str:
    return f"{count} {noun}{'s' * (count != 1)}"


T = TypeVar("T")
FORGE_CHOICES: tuple[ForgeName, ...] = ("github", "gitlab", "none")


def ask_questions(defaults: StartAnswers, answered: frozenset[str], distros: tuple[str, ...]) -> StartAnswers:
    """Ask for everything that no flag has answered. `answered` has the flags' names."""
    click.echo("A few questions; Enter takes what stands in brackets, Ctrl-C leaves everything as it is.\n")
    title = (
        defaults.title if "title" in answered else click.prompt("Title of the project", default=defaults.title).strip()
    )
    distro = defaults.distro
    if "distro" not in answered:
        distro = click.prompt("ROS distribution", default=distro, type=click.Choice(distros))
    partners = defaults.partners if "partner" in answered else _ask_partners()
    groups = defaults.groups if "group" in answered else _ask_groups(defaults.groups, partners)
    forge = defaults.forge
    if "ci" not in answered:
        forge = click.prompt("Where is it reviewed", default=forge, type=click.Choice(FORGE_CHOICES))
    return replace(defaults, title=title, distro=distro, partners=partners, groups=groups, forge=forge)


def _ask_partners() -> tuple[PartnerAnswer, ...]:
    click.echo("\nPartners, one after the other: an id, optionally `id = Title`, and who reviews for them: @handle.")
    partners: list[PartnerAnswer] = []

    def read_partner(words: str) -> PartnerAnswer | None:
        made = start_answers.parse_partner(words) if words.strip() else None
        start_answers.require_distinct([*partners, *([made] if made else [])], "partner")
        return made

    while new_partner := _ask_until(
        f"Partner {len(partners) + 1}, Enter for none" if not partners else "Next, Enter to go on", "", read_partner
    ):
        partners.append(new_partner)
    return tuple(partners)


def _ask_groups(default: tuple[GroupAnswer, ...], partners: tuple[PartnerAnswer, ...]) -> tuple[GroupAnswer, ...]:
    def read_groups(words: str) -> tuple[GroupAnswer, ...]:
        made = tuple(start_answers.parse_group(part, ()) for part in words.split(",") if part.strip())
        start_answers.require_distinct(made, "group")
        return made or default

    chosen_groups = _ask_until(
        "\nFirst functional groups, with commas between", ", ".join(group.id for group in default), read_groups
    )
    if not partners:
        return chosen_groups
    choice = click.Choice([partner.id for partner in partners])
    first = partners[0].id
    return tuple(
        replace(group, owner=click.prompt(f"Owner of {group.title}", default=first, type=choice))
        for group in chosen_groups
    )


def _ask_until(question: str, default: str, read_answer: Callable[[str], T]) -> T:
    def parse_answer(words: str) -> T:
        try:
            return read_answer(words)
        except ValueError as error:
            # click asks again after a UsageError of a `value_proc`.
            raise click.UsageError(str(error)) from None

    answer: T = click.prompt(question, default=default, show_default=bool(default), value_proc=parse_answer)
    return answer
