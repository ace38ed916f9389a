"""`archgen completion`: print the set-up of shell completion."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class


@click.command("completion")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def command(shell: str) -> None:
    """Print what sets up completion in SHELL.

    For instance:

    \b
      archgen completion bash >> ~/.bashrc
      archgen completion zsh >> ~/.zshrc
      archgen completion fish > ~/.config/fish/completions/archgen.fish
    """  # noqa: D301 - click's mark for a block that is not wrapped
    from archgen.cli import main

    completion_class = get_completion_class(shell)
    if completion_class is None:
        raise click.ClickException(f"completion for {shell} is not available")
    click.echo(completion_class(main, {}, "archgen", "_ARCHGEN_COMPLETE").source())
