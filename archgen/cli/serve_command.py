"""`archgen serve`: show the site while its files are edited."""

from __future__ import annotations

import signal
import threading
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity, make_visible
from archgen.products.output_options import OutputOptions

if TYPE_CHECKING:
    from archgen.serve.live_site import LiveSite
    from archgen.serve.site_server import SiteServer
    from archgen.views.pages.report_outline import DetailLevel

DEFAULT_PORT = 8470


@click.command("serve")
@shared_options.project_argument
@click.option("--host", default="127.0.0.1", show_default=True, metavar="ADDRESS", help="The address to listen at.")
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=DEFAULT_PORT,
    show_default=True,
    help="The port to listen at; 0 takes one that is free.",
)
@click.option("--embed", "in_editor", is_flag=True, help="Let Visual Studio Code show it in a frame.")
@click.option("--open", "opens", is_flag=True, help="Open the start page in the browser.")
@shared_options.select_option
@shared_options.variant_option
@shared_options.level_option
@click.option(
    "--since",
    metavar="REV",
    help="Show what changed since a version (as `archgen diff` takes it), which is read once, at the start.",
)
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    host: str,
    port: int,
    in_editor: bool,
    opens: bool,
    select: str | None,
    level: DetailLevel | None,
    since: str | None,
) -> None:
    """Show the site of PROJECT in the browser, and each saved file at once.

    Nothing is written. Errors stand on the page until they are mended. Only this machine can see it unless --host says
    otherwise. Ctrl-C ends it.
    """
    from archgen.project import ProjectNotFoundError
    from archgen.serve.live_site import LiveSite

    options = OutputOptions(selector_text=select or "", level=level, warn=command_support.print_warning)
    with command_support.explain_wrong_usage(ProjectNotFoundError):
        live_site = LiveSite(project, options, since, shared_options.find_asked_variants())
    server = _open_port(live_site, host, port, in_editor=in_editor)
    try:
        _serve(live_site, server, opens=opens)
    except KeyboardInterrupt:
        click.echo("\nstopped", err=True)


def _open_port(live_site: LiveSite, host: str, port: int, *, in_editor: bool) -> SiteServer:
    """Take the port. Raise ClickException where that cannot be."""
    import errno

    from archgen.serve.site_server import SiteServer

    try:
        return SiteServer(live_site, host, port, in_editor=in_editor)
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            msg = f"port {port} of {host} is taken; `--port 0` takes a free one"
        else:
            msg = f"cannot listen at {host}, port {port}: {error.strerror or error}"
        raise click.ClickException(msg) from None


def _serve(live_site: LiveSite, server: SiteServer, *, opens: bool) -> None:
    """Serve until somebody interrupts."""
    import webbrowser

    from archgen.live.file_watch import watch_files

    # A shell that starts something in the background has it ignore interrupts: who sends one all the same means it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    serving = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.2}, daemon=True)
    try:
        _start_site(live_site)
        serving.start()
        _print_state(live_site)
        click.echo(f"serving {live_site.title} at {server.url}  (Ctrl-C ends it)")
        if opens:
            threading.Thread(target=webbrowser.open, args=(server.url,), daemon=True).start()

        def show_change() -> None:
            live_site.refresh()
            _print_state(live_site)

        watch_files(live_site.list_watched_places, show_change, threading.Event())
    finally:
        live_site.stop()
        if serving.is_alive():
            server.shutdown()
        server.server_close()


def _start_site(live_site: LiveSite) -> None:
    """Read the project. What is not there to select, or to compare with, is wrong usage."""
    from archgen.pipeline import UnknownVariantError
    from archgen.serve.project_state import SelectionError

    refused = command_support.explain_wrong_usage(SelectionError, UnknownVariantError)
    with refused, command_support.explain_missing_versions():
        live_site.start()


def _print_state(live_site: LiveSite) -> None:
    """Print what is wrong in the files, or that nothing is, to the error stream."""
    failures = [note["message"] for note in live_site.status.errors if not (note["place"] or note["rule"])]
    for message in failures:
        click.echo(make_visible(f"error: {message}"), err=True)
    if live_site.checked_project is not None and not failures:
        command_support.print_findings_above(live_site.checked_project, lowest_severity=Severity.ERROR)
