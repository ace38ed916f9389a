"""The command line: one file for each verb. Parse the options, call the pipeline, print."""

from __future__ import annotations

import importlib

import click

VERB_GROUPS: dict[str, dict[str, str]] = {
    "write": {
        "init": "Start a project, or take one over from a spreadsheet.",
        "new": "Add a group, a component, an instance, a node, a partner, ...: `archgen new --help`.",
        "rename": "Rename an element in all files, proved to change nothing else.",
        "move": "Move an element into another group or file, split off with its comments.",
        "split": "Put each group, component or section of a file into a file of its own.",
        "undo": "Take back the last rename, move or split.",
        "fmt": "Lay the files out in one style; --check for CI.",
        "import": "Take over from ROS, tables, ReqIF, XMI, AADL, ...: `archgen import --help`.",
        "serve": "Show the site while its files are edited.",
    },
    "check": {
        "check": "Find mistakes in the architecture; --fix mends slips of form.",
        "conform": "Hold the project against the robot: its workspace, its running graph, recordings.",
        "explain": "Explain a rule: why it is there, a bad and a good example.",
        "timing": "Show rates, latency of chains, load; why, what if, what decides.",
        "simulate": "Simulate the timing: what was seen beside the bounds.",
    },
    "look": {
        "show": "Show an element: ports, readers, nodes, place in the files.",
        "find": "Find what words name, or what is said with them.",
        "list": "List elements, connections or backends, as text, CSV or JSON.",
        "stats": "Show size and progress.",
        "start": "Show the plan of the start-up: steps, commands, what each waits for.",
    },
    "publish": {
        "build": "Make everything: report, site, diagrams, packed file.",
        "report": "Write the report as Word, PDF or workbook.",
        "slides": "Write slides for a meeting, as PowerPoint.",
        "site": "Write the static web site.",
        "diagram": "Draw the diagrams.",
    },
    "agree": {
        "diff": "Compare two revisions, folders or files: what changed, and what it means.",
        "review": "Make all that the review of a change needs, in one folder.",
        "merge-check": "Say what would be wrong if open branches were merged.",
        "merge": "Merge a branch by what it says, following what was renamed or moved; checked.",
        "impact": "Show what rests on a partner: what stops if they are late.",
        "todo": "Show what a partner has to do: what most rests on first.",
        "owners": "Show who owns what, or write CODEOWNERS.",
        "interfaces": "Write what flows between two partners, to be signed by both.",
        "sign": "Sign what flows between two partners, so that reviews hold changes against it.",
    },
    "exchange": {
        "pack": "Write one validated YAML file that holds the whole project.",
        "transform": "Write the project as passes make it: types written out, hierarchy taken away.",
        "generate": "Make a workspace: packages, launch files, code.",
        "export": "Make a single file for another tool.",
    },
}
"""The verbs that people use, with their lines in the help, by what they are for."""
PLUMBING = {
    "schema": "Write the JSON Schema with which editors offer the project's own names.",
    "lsp": "Answer an editor over the Language Server Protocol.",
    "mcp": "Answer an assistant over the Model Context Protocol.",
    "merge-driver": "Merge two versions of a file by what they say; for git.",
    "check-requests": "Hold the open requests of a repository against each other; for CI.",
    "comment": "Put a text on the pull request, as one comment that is kept current.",
    "completion": "Print the set-up of shell completion.",
}
"""The verbs that git, editors, shells and workflows call: the help names them without their lines."""
VERBS = {**{verb: line for group in VERB_GROUPS.values() for verb, line in group.items()}, **PLUMBING}
"""Every verb with its line in the help. Each is a module of this package (`verb_module`) with a function `command`."""


def verb_module(verb: str) -> str:
    """Return the name of the module that holds a verb."""
    return f"archgen.cli.{verb.replace('-', '_')}_command"


class VerbGroup(click.Group):
    """A group that imports a verb only when it is called, so that `--help` is immediate."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Return the verbs in the order of their use."""
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002 - the same
        """Import one verb."""
        if cmd_name not in VERBS:
            return None
        # By name, so nothing else refers to these modules: renaming one or its `command` is noticed here only.
        module = importlib.import_module(verb_module(cmd_name))
        command: click.Command = module.command
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Guess what a mistyped verb meant; `help` and `version` are words that people try."""
        if args[:1] == ["help"]:
            args = [*args[1:2], "--help"]
            if args == ["--help"]:
                click.echo(ctx.get_help())
                ctx.exit()
        elif args == ["version"]:
            _print_version(ctx, None, is_requested=True)
        if args and args[0] not in VERBS and not args[0].startswith("-"):
            from archgen.diagnostics import did_you_mean

            guess = did_you_mean(args[0], VERBS)
            ctx.fail(f"there is no verb '{args[0]}'" + (f"; {guess}" if guess else ""))
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002 - the same
        """List the verbs without importing them."""
        for group, verbs in VERB_GROUPS.items():
            with formatter.section(group.capitalize()):
                # Of all groups one column.
                formatter.write_dl([(verb.ljust(_VERB_WIDTH), line) for verb, line in verbs.items()])
        with formatter.section("For git, editors, shells and workflows"):
            formatter.write_text(", ".join(PLUMBING))


_VERB_WIDTH = max(len(verb) for group in VERB_GROUPS.values() for verb in group)


def _print_version(ctx: click.Context, _parameter: click.Parameter | None, is_requested: bool) -> None:  # noqa: FBT001 - click's signature
    if is_requested and not ctx.resilient_parsing:
        from archgen.cli.version_text import format_versions

        click.echo(format_versions())
        ctx.exit()


def _leave_out_plugins(ctx: click.Context, _parameter: click.Parameter, is_requested: bool) -> None:  # noqa: FBT001 - click's signature
    if is_requested and not ctx.resilient_parsing:
        from archgen.installed_plugins import switch_off_others

        switch_off_others()


@click.group(cls=VerbGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.option(
    "--version",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_print_version,
    help="Show the versions in use.",
)
@click.option(
    "--no-plugins",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_leave_out_plugins,
    help="Use no plug-ins but those that ship.",
)
def main() -> None:
    """Design a robot's software architecture together, in git.

    Partners write YAML, a file for each functional group; archgen checks it and makes the report, the site, the
    diagrams and one packed file. Start with `archgen init`, then `archgen check`.
    """
