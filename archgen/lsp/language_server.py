"""The server: texts come in, findings go out, and requests are answered from the project as it is at that moment.

Findings in the protocol's words: the text is that of `archgen check`.
"""

from __future__ import annotations

import asyncio
import contextlib
import gc
import logging
import threading
from collections.abc import Callable, Coroutine
from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol
from pygls.workspace import PositionCodec

from archgen.diagnostics import Diagnostic, Severity, Span, make_visible
from archgen.findings.variant_findings import UNUSED_RULES, phrase_absence
from archgen.live.file_watch import WatchedPlaces, watch_files
from archgen.live.warm_project import EditedProject, WholeCheck
from archgen.lsp.answers import ANSWERS, OPTIONS, RefusedRequestError
from archgen.lsp.element_navigation import FindLine, to_place, to_range
from archgen.lsp.open_projects import OpenProjects
from archgen.pipeline import index_all_rules
from archgen.project import ProjectNotFoundError
from archgen.resources import HOME_URL

_SEVERITIES = {
    Severity.ERROR: types.DiagnosticSeverity.Error,
    Severity.WARNING: types.DiagnosticSeverity.Warning,
    Severity.NOTE: types.DiagnosticSeverity.Information,
}
_DEPRECATION_RULES = frozenset({"deprecated-use", "expired-use"})
_UNNEEDED_RULES = UNUSED_RULES - {"uncovered-requirement"}


def to_message(
    finding: Diagnostic, find_line: FindLine, to_uri: Callable[[str], str], codec: PositionCodec
) -> types.Diagnostic:
    """Return a finding as the protocol has it."""
    parts = [finding.message, phrase_absence(finding), f"help: {finding.help}" if finding.help else None]
    tags = [types.DiagnosticTag.Unnecessary] if finding.rule in _UNNEEDED_RULES else []
    tags += [types.DiagnosticTag.Deprecated] if finding.rule in _DEPRECATION_RULES else []
    related = [
        types.DiagnosticRelatedInformation(
            types.Location(to_uri(label.span.file), to_range(label.span, find_line, codec)), make_visible(label.text)
        )
        for label in finding.labels
        if label.span.file
    ]
    rule = index_all_rules().get(finding.rule)
    has_page = rule is not None and not rule.origin
    return types.Diagnostic(
        range=to_range(finding.span, find_line, codec),
        message="\n".join(make_visible(part) for part in parts if part),
        severity=_SEVERITIES[finding.effective_severity],
        code=finding.rule,
        code_description=types.CodeDescription(f"{HOME_URL}/blob/main/docs/rules/{finding.rule}.md")
        if has_page
        else None,
        source="archgen",
        tags=tags or None,
        related_information=related or None,
    )


_AFTER_A_KEY, _AFTER_THE_LAST, _AT_REST = 0.02, 0.3, 2.0
"""Seconds until a quick check; from the last key until a whole one, and until what waits for a slip to be mended is let go."""


class AnsweringProtocol(LanguageServerProtocol):
    """Answers requests that mean nothing, too: pygls leaves a client waiting for these."""

    def structure_message(self, data: dict[str, Any]) -> Any:  # noqa: ANN401 - messages of all kinds
        """Return a message as it is typed. Raise JsonRpcException, after the error was sent for a request."""
        try:
            return super().structure_message(data)
        except JsonRpcException as error:
            if "method" in data and isinstance(data.get("id"), (int, str)):
                self._send_response(data["id"], error=error.to_response_error())
            raise


class ArchgenServer(LanguageServer):
    """Holds the open projects, and checks each after its texts changed."""

    def __init__(self, version: str) -> None:
        """Wait for a client; `version` is archgen's."""
        # Whole texts: what counts as the end of a line is then said in one place.
        super().__init__(
            "archgen",
            version,
            text_document_sync_kind=types.TextDocumentSyncKind.Full,
            protocol_cls=AnsweringProtocol,
        )
        self.open_projects = OpenProjects()
        self._waiting: dict[EditedProject, list[asyncio.TimerHandle]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._locks: dict[EditedProject, asyncio.Lock] = {}
        self._published: dict[str, tuple[EditedProject, list[types.Diagnostic], int | None]] = {}

    def report_server_error(self, error: Exception, source: Any) -> None:  # noqa: ANN401 - as pygls calls it
        """Show nobody what a client sent wrongly: it is logged, and a request is answered."""

    def take_text(self, uri: str) -> None:
        """Take the text of an open file, and check its project soon."""
        text = self.workspace.get_text_document(uri).source
        found = self.open_projects.open_file(uri, text)
        if found is None:
            self._publish(uri, None, [])
            return
        project, file = found
        self._check_again(project, is_changed=project.set_text(file, text))

    def drop_text(self, uri: str) -> None:
        """Take a file that is closed as it is on the disk."""
        found = self.open_projects.find_file(uri)
        self.open_projects.close_file(uri)
        if found is not None:
            self._check_again(found[0], is_changed=found[0].drop_text(found[1]))

    def _check_again(self, project: EditedProject, *, is_changed: bool) -> None:
        if is_changed:
            self.plan_checks(project)
        else:
            self.publish_findings(project)

    def plan_checks(self, project: EditedProject) -> None:
        """Check a project in a moment, and wholly when nobody types any more."""
        loop = asyncio.get_running_loop()
        quick, *later = self._waiting.get(project, (None,))
        for timer in later:
            timer.cancel()
        # Whoever types fast is not waited for: only what comes later is put off.
        if quick is None or quick.when() <= loop.time():
            quick = loop.call_later(_AFTER_A_KEY, self._run_phase, project, project.check_quickly)
        self._waiting[project] = [
            quick,
            loop.call_later(_AFTER_THE_LAST, lambda: self._keep_task(self._check_wholly(project))),
            loop.call_later(_AT_REST, self._run_phase, project, project.settle),
        ]

    def _keep_task(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _check_wholly(self, project: EditedProject) -> None:
        """Check everything in a thread: chains that nothing proves are simulated for seconds, and requests come meanwhile."""
        loop = asyncio.get_running_loop()
        started, generation = loop.time(), project.generation
        async with self._locks.setdefault(project, asyncio.Lock()):
            if project.generation != generation:  # another one is planned
                return
            result: asyncio.Future[WholeCheck | Exception] = loop.create_future()
            check = project.start_whole_check()

            def run() -> None:
                try:
                    found: WholeCheck | Exception = check()
                except Exception as error:  # noqa: BLE001 - told where the others are
                    found = error
                with contextlib.suppress(RuntimeError):  # the server has ended
                    loop.call_soon_threadsafe(result.set_result, found)

            threading.Thread(target=run, daemon=True).start()
            found = await result
            self._run_phase(project, lambda: self._take(project, found))
            if project.is_whole and loop.time() - started > _AT_REST - _AFTER_THE_LAST:
                self._run_phase(project, project.settle)
        self._ask_to_look_again()
        # The command line collects no garbage, since a run is short; this one is not.
        gc.collect()

    def _take(self, project: EditedProject, found: WholeCheck | Exception) -> None:
        if isinstance(found, Exception):
            raise found
        project.take_whole_check(found)

    def watch_files(self) -> None:
        """Have the client tell of files that change on the disk; look for them where it cannot."""
        workspace = self.client_capabilities.workspace
        watching = workspace.did_change_watched_files if workspace else None
        if watching and watching.dynamic_registration:
            watchers = [
                types.FileSystemWatcher(f"**/*.{ending}") for ending in ("yaml", "yml", "md", "msg", "srv", "action")
            ]
            options = types.DidChangeWatchedFilesRegistrationOptions(watchers)
            registration = types.Registration("files", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
            self.client_register_capability(types.RegistrationParams([registration]))
            return
        loop = asyncio.get_running_loop()

        def choose_places() -> WatchedPlaces:
            return WatchedPlaces(tuple(project.warm.root for project in list(self.open_projects.projects.values())))

        def tell() -> None:
            loop.call_soon_threadsafe(self.read_again)

        threading.Thread(target=watch_files, args=(choose_places, tell, threading.Event()), daemon=True).start()

    def read_again(self) -> None:
        """Check everything again: files on the disk have changed."""
        for project in self.open_projects.projects.values():
            project.look_again()
            self.plan_checks(project)

    def _ask_to_look_again(self) -> None:
        """Let the client ask again for what follows from timing and variants."""
        workspace = self.client_capabilities.workspace
        if workspace and workspace.code_lens and workspace.code_lens.refresh_support:
            self.workspace_code_lens_refresh(None)
        if workspace and workspace.inlay_hint and workspace.inlay_hint.refresh_support:
            self.workspace_inlay_hint_refresh(None)

    def _run_phase(self, project: EditedProject, check: Any) -> None:  # noqa: ANN401 - a method of the project
        try:
            check()
        except ProjectNotFoundError as error:
            gone = types.Diagnostic(
                types.Range(types.Position(0, 0), types.Position(0, 0)), str(error), source="archgen"
            )
            for uri, _ in list(self.open_projects.list_open_files(project)):
                self._publish(uri, project, [gone])
            return
        except Exception:  # the next text may be judged again
            logging.getLogger(__name__).exception("a check failed")
            return
        self.publish_findings(project)

    def publish_findings(self, project: EditedProject) -> None:
        """Tell what is found, of each file where that is news, of open files for each of their versions."""
        by_file: dict[str, list[types.Diagnostic]] = {}
        for finding in project.findings:
            by_file.setdefault(self.write_uri(project, finding.span.file or project.warm.first_file), []).append(
                self.write_finding(project, finding)
            )
        open_uris = [uri for uri, _ in self.open_projects.list_open_files(project)]
        known = [uri for uri, (owner, messages, _) in self._published.items() if owner is project and messages]
        for uri in dict.fromkeys((*by_file, *open_uris, *known)):
            self._publish(uri, project, by_file.get(uri, []))

    def _publish(self, uri: str, project: EditedProject | None, messages: list[types.Diagnostic]) -> None:
        document = self.workspace.text_documents.get(uri)
        version = document.version if document else None
        owner, last_messages, last_version = self._published.get(uri, (project, None, None))
        # A library's file shows what the project says that was opened first.
        if (owner is not project and owner is not None) or (last_messages == messages and last_version == version):
            return
        if last_messages is None and not messages and version is None:
            return
        self._published[uri] = (project, messages, version) if project else (None, messages, version)  # type: ignore[assignment]
        self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, messages, version))

    @property
    def codec(self) -> Any:  # noqa: ANN401 - pygls exports no name for it
        """What converts columns into the units of the client."""
        return self.workspace.position_codec

    def to_place(self, project: EditedProject, file: str, position: types.Position) -> tuple[int, int]:
        """Return line and column, from 1, of a position in a file of a project."""
        return to_place(position, project.line_of(file, position.line + 1) or "", self.codec)

    def to_range(self, project: EditedProject, span: Span) -> types.Range:
        """Return the range of a span in a file of a project."""
        return to_range(span, project.line_of, self.codec)

    def write_finding(self, project: EditedProject, finding: Diagnostic) -> types.Diagnostic:
        """Return a finding as the client has it."""
        return to_message(finding, project.line_of, lambda file: self.write_uri(project, file), self.codec)

    def write_uri(self, project: EditedProject, file: str) -> str:
        """Return the address of a project's file."""
        return self.open_projects.write_uri(project, file)


def log_in_lines() -> None:
    """Write what goes wrong to the error stream, a line each: what a client sends is no reason for pages."""

    class _OneLine(logging.Filter):
        def filter(self, record: logging.LogRecord) -> bool:
            error = record.exc_info[1] if record.exc_info else None
            if isinstance(error, RefusedRequestError):  # the client shows it
                return False
            record.msg = make_visible(f"{record.getMessage().partition(chr(10))[0]}{f': {error!r}' if error else ''}")[
                :500
            ]
            record.args, record.exc_info, record.exc_text = (), None, None
            return True

    handler = logging.StreamHandler()
    handler.addFilter(_OneLine())
    logging.basicConfig(level=logging.WARNING, format="archgen lsp: %(message)s", handlers=[handler])


def create_server(version: str) -> ArchgenServer:
    """Return a server with all that it answers; `version` is archgen's."""
    server = ArchgenServer(version)
    for method, answer in ANSWERS.items():
        server.feature(method, OPTIONS.get(method))(answer)
    return server
