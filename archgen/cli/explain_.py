"""`archgen explain`: explain a rule."""

from __future__ import annotations

import click

from archgen.suggest import did_you_mean


@click.command("explain")
@click.argument("rule", required=False)
def command(rule: str | None) -> None:
    """Explain RULE: why it is there, a bad and a good example. Without RULE, list all rules."""
    from archgen import pipeline
    from archgen.findings import explain

    rules = {each.name: each for each in pipeline.ALL_RULES}
    if rule is None:
        click.echo(explain.listing(pipeline.ALL_RULES), nl=False)
    elif rule in rules:
        click.echo(explain.page(rules[rule]), nl=False)
    else:
        guess = did_you_mean(rule, rules)
        msg = f"there is no rule '{rule}'" + (f"; {guess}" if guess else "")
        raise click.UsageError(msg)
