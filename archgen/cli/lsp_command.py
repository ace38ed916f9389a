"""`archgen lsp`: the language server, for editors."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys

import click


@click.command("lsp")
@click.option("--stdio", is_flag=True, hidden=True)  # what some editors add to every server
def command(*, stdio: bool) -> None:  # noqa: ARG001 - it is the only way there is
    """Speak the Language Server Protocol on standard input and output; an editor starts it.

    It finds the project of each file that is opened, checks it while somebody types, and writes nothing.
    """
    if importlib.util.find_spec("pygls") is None:
        raise click.UsageError('archgen lsp needs pygls: pip install "archgen[lsp]"')
    from archgen import __version__
    from archgen.lsp.language_server import create_server, log_in_lines

    # Nothing is ever half written, and the thread that waits for the editor would keep the process.
    signal.signal(signal.SIGTERM, lambda number, _: os._exit(128 + number))
    pipe = sys.stdout.buffer
    # Nothing but messages may come on the pipe, whoever prints.
    sys.stdout = sys.stderr
    log_in_lines()
    create_server(__version__).start_io(stdout=pipe)
