"""`archgen explain`: explain a rule, or say where a component type that ships was read."""

from __future__ import annotations

import os
import sys

import click

from archgen.cli import shared_options
from archgen.diagnostics import did_you_mean, name_rule
from archgen.diagnostics.text_columns import align_rows, find_width


@click.command("explain")
@click.argument("rule", required=False)
@click.option(
    "--distro", metavar="NAME", help="With `ros.TYPE`: the file and the line of each fact, for a distribution of ROS."
)
@shared_options.format_option("text", "json")
def command(rule: str | None, distro: str | None, form: str) -> None:
    """Explain RULE: why it is there, a bad and a good example. Without RULE, list all rules.

    For a component type that ships, such as `ros.amcl`, say where it was read.
    """
    if rule is None and distro is not None:
        raise click.UsageError("--distro goes with a component type that ships, such as `ros.amcl`")
    if rule is not None and (distro is not None or "." in rule):
        if form == "json":
            raise click.UsageError("--format json goes with rules")
        explain_sources(rule, distro)
        return
    from archgen import pipeline
    from archgen.emit.terminal.findings_text import wants_colour
    from archgen.findings import rule_pages
    from archgen.findings.rule_table import COMPARISON_RULES, index_rules
    from archgen.views.generation.architecture_needs import GENERATION_RULES

    rules = index_rules((*pipeline.index_all_rules().values(), *COMPARISON_RULES, *GENERATION_RULES))
    width = find_width(sys.stdout)
    if form == "json" and (rule is None or name_rule(rule) in rules):
        from archgen.emit.data.answers_json import format_rules_json

        sys.stdout.write(format_rules_json(rules.values() if rule is None else [rules[name_rule(rule)]]))
    elif rule is None:
        rows = ((name, str(each.severity), rule_pages.summarise_rule(each)) for name, each in rules.items())
        for line in align_rows(rows, width, indent=""):
            click.echo(line)
    elif name_rule(rule) in rules:
        click.echo(
            rule_pages.format_rule_page(
                rules[name_rule(rule)], colour=wants_colour(sys.stdout, os.environ), width=width
            ),
            nl=False,
        )
    else:
        guess = did_you_mean(rule, rules)
        raise click.UsageError(f"there is no rule '{rule}'" + (f"; {guess}" if guess else ""))


def explain_sources(name: str, distro: str | None) -> None:
    """Print where the facts about a shipped component type were read; raise UsageError where there is none of that name."""
    from archgen.cli.type_sources import list_shipped_names, list_source_lines
    from archgen.model.known_interfaces import KNOWN_DISTROS

    names = list_shipped_names()
    if name not in names:
        msg = f"no component type named '{name}' ships with archgen"
        guess = did_you_mean(name, names)
        raise click.UsageError(f"{msg}; {guess}" if guess else msg)
    if distro is not None and distro not in KNOWN_DISTROS:
        raise click.UsageError(f"nothing ships for the distribution '{distro}'; there are {', '.join(KNOWN_DISTROS)}")
    lines = list(list_source_lines(name, distro))
    if not lines:
        raise click.UsageError(f"'{name}' does not ship for {distro}; `archgen explain {name}` says for which it does")
    for line in lines:
        click.echo(line)
