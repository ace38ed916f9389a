"""What the server answers to each message: a place in a text comes in, places and words go out.

Flow as calls: who feeds a component, and who reads what it gives.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from archgen.diagnostics import Span, make_visible
from archgen.diagnostics.suggested_fixes import TextEdit
from archgen.edit.element_edit import EditRefusedError, FileEdit
from archgen.edit.formatted_slices import format_text, keeps_findings
from archgen.live.warm_project import EditedProject
from archgen.lsp.completion import list_offers
from archgen.lsp.editor_edits import find_findings, list_fixes, plan_certain_edits, plan_edits
from archgen.lsp.element_hints import OTHER_TOKEN, TOKEN_MODIFIERS, TOKEN_TYPES, list_inlays, list_lenses, list_tokens
from archgen.lsp.element_navigation import (
    SYMBOL_KINDS,
    describe_element,
    describe_key,
    describe_message,
    find_declared,
    find_element,
    find_named_file,
    list_declarations,
    list_folds,
    list_mentions,
    list_symbols,
)
from archgen.model.component_nesting import find_component
from archgen.syntax.mended_text import measure_common_lines, split_lines
from archgen.syntax.slice_layout import UnformattableError

if TYPE_CHECKING:
    from archgen.lsp.element_navigation import FoundName
    from archgen.lsp.language_server import ArchgenServer


def find_flow_component(project: EditedProject, kind: str, element_id: str) -> str | None:
    """Return the component that an element is, or whose port it is; None where it is neither."""
    architecture = project.checked.architecture
    component_id = element_id if kind == "component" else element_id.rpartition(".")[0]
    is_known = component_id in architecture.components or component_id in architecture.shells
    return component_id if is_known and kind in {"component", "input", "output"} else None


def describe_component(project: EditedProject, component_id: str) -> tuple[str, Span]:
    """Return the title of a component, and where it is declared."""
    component = find_component(project.checked.architecture, component_id)
    return component.title, component.at


def list_flows(project: EditedProject, component_id: str, *, is_incoming: bool) -> Iterator[tuple[str, list[Span]]]:
    """Yield the components that feed one, or that read it, each with where the outputs stand that flow there."""
    architecture = project.checked.architecture
    inside = frozenset(architecture.leaves_of(component_id))
    flows: dict[str, dict[Span, None]] = {}
    for connection in architecture.connections:
        reader = architecture.inputs[connection.input].component
        for output_id in connection.outputs:
            output = architecture.outputs[output_id]
            ends = (reader, output.component) if is_incoming else (output.component, reader)
            if ends[0] in inside and ends[1] not in inside:
                flows.setdefault(ends[1], {})[output.at] = None
    for other, spans in flows.items():
        yield other, list(spans)


Answer = Callable[..., Any]


class RefusedRequestError(JsonRpcException):
    """What is asked is not done; the client shows the reason."""

    CODE = types.LSPErrorCodes.RequestFailed

    def __init__(self, reason: str) -> None:
        super().__init__(make_visible(reason))


def _of_file(answer: Answer) -> Answer:
    """Answer about a file with its project; with nothing about a file of no open project."""

    def call(ls: ArchgenServer, params: Any) -> Any:  # noqa: ANN401 - whatever is asked
        found = ls.open_projects.find_file(params.text_document.uri)
        return answer(ls, *found, params) if found else None

    return call


def _of_name(answer: Answer) -> Answer:
    """Answer about the element that is named at a place; with nothing where none is."""

    def call(ls: ArchgenServer, project: EditedProject, file: str, params: Any) -> Any:  # noqa: ANN401 - whatever is asked
        name = find_element(project, file, *ls.to_place(project, file, params.position))
        return answer(ls, project, file, params, name) if name else None

    return _of_file(call)


def _locate(ls: ArchgenServer, project: EditedProject, spans: Iterable[Span]) -> list[types.Location]:
    return [types.Location(ls.write_uri(project, span.file), ls.to_range(project, span)) for span in spans]


def _word_span(file: str, name: FoundName) -> Span:
    line = name.name.span.line
    return Span(file, line, name.word[0], line, name.word[1])


def _define(
    ls: ArchgenServer, project: EditedProject, file: str, params: types.DefinitionParams
) -> list[types.Location]:
    line, column = ls.to_place(project, file, params.position)
    name = find_element(project, file, line, column)
    if name is not None:
        return _locate(ls, project, (each.span for each in list_declarations(project, name.element)))
    named_file = find_named_file(project, file, line, column)
    return _locate(ls, project, [Span.of_file(named_file)]) if named_file else []


def _refer(
    ls: ArchgenServer, project: EditedProject, _: str, params: types.ReferenceParams, name: FoundName
) -> list[types.Location]:
    with_declarations = params.context.include_declaration
    mentions = list_mentions(project, name.element)
    spans = dict.fromkeys(span for each, span in mentions if with_declarations or not each.is_declaration)
    return _locate(ls, project, spans)


def _highlight(
    ls: ArchgenServer, project: EditedProject, file: str, _: object, name: FoundName
) -> list[types.DocumentHighlight]:
    spans = dict.fromkeys(span for _, span in list_mentions(project, name.element) if span.file == file)
    return [types.DocumentHighlight(ls.to_range(project, span)) for span in spans]


def _hover(ls: ArchgenServer, project: EditedProject, file: str, params: types.HoverParams) -> types.Hover | None:
    line, column = ls.to_place(project, file, params.position)
    name = find_element(project, file, line, column)
    text = describe_element(project, name.element, lambda each: ls.write_uri(project, each)) if name else None
    text = text or describe_message(project, file, line, column) or describe_key(project, file, line, column)
    content = types.MarkupContent(types.MarkupKind.Markdown, text or "")
    return types.Hover(content, ls.to_range(project, _word_span(file, name)) if name else None) if text else None


def _find_symbols(ls: ArchgenServer, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
    return [
        types.WorkspaceSymbol(
            name=name.id,
            kind=SYMBOL_KINDS.get(name.kind, types.SymbolKind.Constant),
            location=_locate(ls, project, [name.span])[0],
            container_name=name.kind.replace("_", " "),
        )
        for project in ls.open_projects.projects.values()
        for name in find_declared(project, params.query)
    ]


def _complete(
    ls: ArchgenServer, project: EditedProject, file: str, params: types.CompletionParams
) -> types.CompletionList:
    line, column = ls.to_place(project, file, params.position)
    items = [
        types.CompletionItem(
            label=offer.label,
            kind=offer.kind,
            detail=offer.detail or None,
            documentation=offer.explanation or None,
            sort_text=f"{number:05}",
            filter_text=offer.label,
            text_edit=types.TextEdit(
                ls.to_range(project, Span(file, line, min(offer.column, column), line, column)), offer.text
            ),
        )
        for number, offer in enumerate(list_offers(project, file, line, column))
    ]
    return types.CompletionList(is_incomplete=False, items=items)


def _write_edits(
    ls: ArchgenServer, project: EditedProject, edits: Iterable[TextEdit], notes: str = ""
) -> types.WorkspaceEdit:
    """Return edits of files, of the versions that they were made of; with notes, the client asks before it makes them."""
    by_file: dict[str, list[Any]] = {}
    for edit in edits:
        place = ls.to_range(project, edit.span)
        by_file.setdefault(ls.write_uri(project, edit.span.file), []).append(
            types.AnnotatedTextEdit("notes", place, edit.text) if notes else types.TextEdit(place, edit.text)
        )
    documents = ls.workspace.text_documents
    changes = [
        types.TextDocumentEdit(
            types.OptionalVersionedTextDocumentIdentifier(uri, documents[uri].version if uri in documents else None),
            made,
        )
        for uri, made in by_file.items()
    ]
    annotation = types.ChangeAnnotation("this follows from it", needs_confirmation=True, description=notes)
    return types.WorkspaceEdit(document_changes=changes, change_annotations={"notes": annotation} if notes else None)


def _fix(
    ls: ArchgenServer, project: EditedProject, file: str, params: types.CodeActionParams
) -> list[types.CodeAction]:
    first, last = params.range.start.line + 1, params.range.end.line + 1
    # First what is found of the project as it is now: of an older text no fix is right.
    project.checked  # noqa: B018 - checked by being asked for
    actions = [
        types.CodeAction(
            title=fix.title,
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[ls.write_finding(project, finding)],
            is_preferred=fix.is_preferred,
            edit=_write_edits(ls, project, fix.edits),
        )
        for finding in find_findings(project, file, first, last)
        for fix in list_fixes(project, finding)
    ]
    certain_edits = plan_certain_edits(project, file)
    if certain_edits:
        title = "make all fixes of which nothing else can be meant"
        edit = _write_edits(ls, project, certain_edits)
        actions.append(types.CodeAction(title, types.CodeActionKind.SourceFixAll, edit=edit))
    wanted = params.context.only
    return [each for each in actions if not wanted or any(str(each.kind.value).startswith(kind) for kind in wanted)]  # type: ignore[union-attr]


def _prepare_rename(
    ls: ArchgenServer, project: EditedProject, file: str, _: object, name: FoundName
) -> types.PrepareRenamePlaceholder:
    span = _word_span(file, name)
    word = (project.line_of(file, span.line) or "")[span.column - 1 : span.end_column - 1]
    return types.PrepareRenamePlaceholder(ls.to_range(project, span), word.rpartition(".")[2])


def _rename(
    ls: ArchgenServer, project: EditedProject, _: str, params: types.RenameParams, name: FoundName
) -> types.WorkspaceEdit:
    try:
        edits, notes = plan_edits(project, name.element, params.new_name)
    except EditRefusedError as refusal:
        raise RefusedRequestError("; ".join(filter(None, (refusal.message, refusal.by_hand)))) from None
    workspace = ls.client_capabilities.workspace
    can_ask = workspace and workspace.workspace_edit and workspace.workspace_edit.change_annotation_support
    if notes and not can_ask:
        ls.window_show_message(types.ShowMessageParams(types.MessageType.Info, "\n".join(notes)))
    return _write_edits(ls, project, edits, "\n".join(notes) if can_ask else "")


_SILENCES_ANOTHER = "a comment `archgen: ignore` would reach something else"


def _lay_out(ls: ArchgenServer, project: EditedProject, file: str, _: object) -> list[types.TextEdit]:
    if file not in project.checked.yaml_files:
        return []
    text = project.warm.text_of(file) or ""
    try:
        new_text = format_text(text)
    except UnformattableError as error:
        place = f" (line {error.line})" if error.line else ""
        raise RefusedRequestError(error.reason + place) from None
    edit = FileEdit(file, text.encode("utf-8", "surrogatepass"), new_text.encode("utf-8", "surrogatepass"), 1)
    if new_text != text and not keeps_findings(project.checked, [edit]):
        raise RefusedRequestError(_SILENCES_ANOTHER)
    old_lines, new_lines = split_lines(text), split_lines(new_text)
    above, below = measure_common_lines(old_lines, new_lines)
    span = Span(file, above + 1, 1, len(old_lines) - below + 1, 1)
    written = "".join(new_lines[above : len(new_lines) - below])
    return [types.TextEdit(ls.to_range(project, span), written)] if new_text != text else []


def _show_lenses(ls: ArchgenServer, project: EditedProject, file: str, _: object) -> list[types.CodeLens]:
    hints = list_lenses(project, file)
    return [types.CodeLens(ls.to_range(project, hint.span), types.Command(hint.text, "")) for hint in hints]


def _show_inlays(
    ls: ArchgenServer, project: EditedProject, file: str, params: types.InlayHintParams
) -> list[types.InlayHint]:
    lines = range(params.range.start.line + 1, params.range.end.line + 2)
    return [
        types.InlayHint(ls.to_range(project, hint.span).end, hint.text, padding_left=True)
        for hint in list_inlays(project, file)
        if hint.span.line in lines
    ]


_TOKEN_TYPES = list(dict.fromkeys((*TOKEN_TYPES.values(), OTHER_TOKEN)))


def _colour(ls: ArchgenServer, project: EditedProject, file: str, _: object) -> types.SemanticTokens:
    """Return the words of all names in a file: each five numbers, its place counted from the one before."""
    data: list[int] = []
    line, character = 0, 0
    for token in list_tokens(project, file):
        place = ls.to_range(project, token.span)
        lines_down = place.start.line - line
        right = place.start.character - (0 if lines_down else character)
        bits = sum(1 << TOKEN_MODIFIERS.index(modifier) for modifier in token.modifiers)
        data += (lines_down, right, place.end.character - place.start.character, _TOKEN_TYPES.index(token.type), bits)
        line, character = place.start.line, place.start.character
    return types.SemanticTokens(data)


def _find_flows(
    ls: ArchgenServer, project: EditedProject, _: str, __: object, name: FoundName
) -> list[types.CallHierarchyItem]:
    component = find_flow_component(project, *name.element)
    return [_write_component(ls, project, component)] if component else []


def _write_component(ls: ArchgenServer, project: EditedProject, component_id: str) -> types.CallHierarchyItem:
    title, span = describe_component(project, component_id)
    place = ls.to_range(project, span)
    uri = ls.write_uri(project, span.file)
    return types.CallHierarchyItem(component_id, types.SymbolKind.Class, uri, place, place, detail=title)


def _follow(call: type[Any], *, is_incoming: bool) -> Answer:
    """Return what answers who feeds a component, or who reads what it gives."""

    def answer(ls: ArchgenServer, params: Any) -> list[Any]:  # noqa: ANN401 - of both directions
        found = ls.open_projects.find_file(params.item.uri)
        if found is None or find_flow_component(found[0], "component", params.item.name) is None:
            return []
        project = found[0]
        return [
            call(_write_component(ls, project, other), [ls.to_range(project, span) for span in spans])
            for other, spans in list_flows(project, params.item.name, is_incoming=is_incoming)
        ]

    return answer


ANSWERS: Mapping[str, Answer] = {
    types.INITIALIZED: lambda ls, _: ls.watch_files(),
    types.TEXT_DOCUMENT_DID_OPEN: lambda ls, params: ls.take_text(params.text_document.uri),
    types.TEXT_DOCUMENT_DID_CHANGE: lambda ls, params: ls.take_text(params.text_document.uri),
    types.TEXT_DOCUMENT_DID_CLOSE: lambda ls, params: ls.drop_text(params.text_document.uri),
    types.TEXT_DOCUMENT_DID_SAVE: lambda ls, _: ls.read_again(),
    types.WORKSPACE_DID_CHANGE_WATCHED_FILES: lambda ls, _: ls.read_again(),
    types.WORKSPACE_SYMBOL: _find_symbols,
    types.TEXT_DOCUMENT_DEFINITION: _of_file(_define),
    types.TEXT_DOCUMENT_REFERENCES: _of_name(_refer),
    types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT: _of_name(_highlight),
    types.TEXT_DOCUMENT_HOVER: _of_file(_hover),
    types.TEXT_DOCUMENT_DOCUMENT_SYMBOL: _of_file(lambda ls, project, file, _: list_symbols(project, file, ls.codec)),
    types.TEXT_DOCUMENT_FOLDING_RANGE: _of_file(lambda _, project, file, __: list_folds(project, file)),
    types.TEXT_DOCUMENT_COMPLETION: _of_file(_complete),
    types.TEXT_DOCUMENT_CODE_ACTION: _of_file(_fix),
    types.TEXT_DOCUMENT_FORMATTING: _of_file(_lay_out),
    types.TEXT_DOCUMENT_PREPARE_RENAME: _of_name(_prepare_rename),
    types.TEXT_DOCUMENT_RENAME: _of_name(_rename),
    types.TEXT_DOCUMENT_CODE_LENS: _of_file(_show_lenses),
    types.TEXT_DOCUMENT_INLAY_HINT: _of_file(_show_inlays),
    types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL: _of_file(_colour),
    types.TEXT_DOCUMENT_PREPARE_CALL_HIERARCHY: _of_name(_find_flows),
    types.CALL_HIERARCHY_INCOMING_CALLS: _follow(types.CallHierarchyIncomingCall, is_incoming=True),
    types.CALL_HIERARCHY_OUTGOING_CALLS: _follow(types.CallHierarchyOutgoingCall, is_incoming=False),
}
"""What is called for each message of a client."""
OPTIONS: Mapping[str, Any] = {
    types.TEXT_DOCUMENT_RENAME: types.RenameOptions(prepare_provider=True),
    types.TEXT_DOCUMENT_COMPLETION: types.CompletionOptions(trigger_characters=[".", ":", " ", "[", "{", "<", "-"]),
    types.TEXT_DOCUMENT_CODE_ACTION: types.CodeActionOptions(
        code_action_kinds=[types.CodeActionKind.QuickFix, types.CodeActionKind.SourceFixAll]
    ),
    types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL: types.SemanticTokensLegend(_TOKEN_TYPES, list(TOKEN_MODIFIERS)),
}
"""What the server says of some of its answers."""
