"""`archgen explain`: explain a rule."""

from __future__ import annotations

import os
import sys

import click

from archgen.diagnostics.suggestions import did_you_mean


@click.command("explain")
@click.argument("rule", required=False)
def command(rule: str | None) -> None:
    """Explain RULE: why it is there, a bad and a good example. Without RULE, list all rules."""
    from archgen import pipeline
    from archgen.diagnostics.text_columns import align_rows, find_width
    from archgen.emit.terminal.findings_text import wants_colour
    from archgen.findings import rule_pages
    from archgen.findings.comparison_rules import COMPARISON_RULES
    from archgen.findings.generation_rules import GENERATION_RULES
    from archgen.findings.rule_table import index_rules

    rules = index_rules((*pipeline.ALL_RULES, *COMPARISON_RULES, *GENERATION_RULES))
    width = find_width(sys.stdout)
    if rule is None:
        rows = ((name, str(each.severity), rule_pages.parse_rule_page(each).summary) for name, each in rules.items())
        for line in align_rows(rows, width, indent=""):
            click.echo(line)
    elif rule in rules:
        click.echo(
            rule_pages.format_rule_page(rules[rule], colour=wants_colour(sys.stdout, os.environ), width=width), nl=False
        )
    else:
        guess = did_you_mean(rule, rules)
        msg = f"there is no rule '{rule}'" + (f"; {guess}" if guess else "")
        raise click.UsageError(msg)
