"""Outputs with what they promise: frames named by parameters, replacements resolved, and what is passed on kept."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from archgen.diagnostics import NO_SPAN, Label
from archgen.frozen import NamedTuple, replace
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.element_outline import ElementOutline
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.component import Output
from archgen.model.promise import PROMISE_KEYS, Deprecation, Promise

if TYPE_CHECKING:
    from archgen.link.port_sources import PortKey, PortSources


class _OutputWords(NamedTuple):
    """What is said of an output, by itself or by what it passes on."""

    promise: Promise | None = None
    version: str | None = None
    deprecated: Deprecation | None = None


_NOTHING = _OutputWords()


class PromisedOutputs:
    """Completes outputs with what they promise; of composed components with what they keep of what they pass on."""

    def __init__(
        self,
        outline: ElementOutline,
        sources: PortSources | None,
        parameters: HandedParameters,
        resolver: ReferenceResolver,
    ) -> None:
        """Take what the project declares; replacements that are not there go to the resolver's diagnostics."""
        self._outline = outline
        self._sources = sources
        self._parameters = parameters
        self._resolver = resolver
        self._own: dict[str, _OutputWords] = {}
        self._kept: dict[str, _OutputWords] = {}

    def complete_output(self, output: Output) -> Output:
        """Return an output with all that is said of it."""
        if not self._outline.promises_something:
            return output  # nearly every project
        said = self._find_said(output.id)
        return replace(output, promise=said.promise, version=said.version, deprecated=said.deprecated)

    def _find_said(self, output_id: str) -> _OutputWords:
        """Return what is said of an output: its own, else what is said of what it passes on.

        Without recursion: what only passes on may stand behind one another in thousands.
        """
        way: list[str] = []
        current: str | None = output_id
        while current is not None and current not in self._kept and current not in way:
            way.append(current)
            current = self._find_given(current)
        said = self._kept.get(current or "", _NOTHING)
        for each in reversed(way):
            given = said if each != way[-1] or current is not None else self._join_given(each)
            said = _lay_over(self._lift_replacement(given, each), self._find_own(each))
            self._kept[each] = said
        return said

    def _find_given(self, output_id: str) -> str | None:
        """Return the one output that an output of a composed component passes on; None for none, and for several."""
        port: PortKey = ("output", output_id)
        seen_ports: set[PortKey] = set()
        while self._sources is not None and port not in seen_ports:
            seen_ports.add(port)
            if port[0] == "output" and port[1].rpartition(".")[0] not in self._outline.shells:
                return None
            targets = [source.target for source in self._sources.list_sources(port)]
            if len(targets) != 1 or targets[0].kind not in {"output", "input"}:
                return None
            port = (targets[0].kind, targets[0].id)
            if port[0] == "output":
                return port[1]
        return None

    def _join_given(self, output_id: str) -> _OutputWords:
        """Return what all outputs say that an output passes on together: what one of them does not say, nobody keeps."""
        if self._sources is None or output_id.rpartition(".")[0] not in self._outline.shells:
            return _NOTHING
        behind = self._sources.leaf_outputs_of(output_id)
        said = [self._find_own(leaf) for leaf in behind if leaf != output_id]
        if not said:
            return _NOTHING
        first = said[0]
        return _OutputWords(
            _join_promises([each.promise for each in said]),
            first.version if all(each.version == first.version for each in said) else None,
            first.deprecated if all(each.deprecated == first.deprecated for each in said) else None,
        )

    def _lift_replacement(self, output_words: _OutputWords, output_id: str) -> _OutputWords:
        """Return what is passed on with the replacement as seen from outside: the port that gives the replacement on."""
        shell_id = output_id.rpartition(".")[0]
        target = output_words.deprecated.target if output_words.deprecated else None
        if target is None or output_words.deprecated is None or shell_id not in self._outline.shells:
            return output_words
        ports = (f"{shell_id}.{name}" for name in self._outline.outputs[shell_id])
        lifted = next((port for port in ports if self._find_given(port) == target), target)
        return output_words._replace(deprecated=replace(output_words.deprecated, target=lifted))

    def _find_own(self, output_id: str) -> _OutputWords:
        """Return what is written at an output, each reference resolved once."""
        if output_id not in self._own:
            component_id, _, name = output_id.rpartition(".")
            output = self._outline.outputs[component_id][name]
            promise, deprecated = output.promise, output.deprecated
            if promise and promise.frame and "$" in promise.frame:
                place = promise.places.get("frame", promise.at)
                promise = replace(promise, frame=self._parameters.fill_in_name(promise.frame, component_id, place))
            if deprecated and deprecated.use:
                deprecated = replace(deprecated, target=self._resolve_use(deprecated, component_id))
            self._own[output_id] = _OutputWords(promise, output.version, deprecated)
        return self._own[output_id]

    def _resolve_use(self, deprecated: Deprecation, component_id: str) -> str | None:
        """Return the output that `use` names: one of the same component, or a complete path."""
        text = deprecated.use or ""
        outputs, known = self._outline.outputs[component_id], self._resolver.spans["output"]
        if text in outputs:
            return f"{component_id}.{text}"
        if text in known:
            return text
        if not self._resolver.is_lost(text) and not self._resolver.is_lost(f"{component_id}.{text}"):
            guess = self._resolver.guesser.guess_name(text, outputs if "." not in text else known)
            span = outputs[guess].at if guess in outputs else known.get(guess or "", NO_SPAN)
            self._resolver.report(
                "unknown-reference",
                f"`{text}` is no output of `{component_id}`, and no complete path of another one",
                deprecated.use_at,
                labels=(Label(span, "declared here"),) if guess and span != NO_SPAN else (),
                help_line=f"did you mean `{guess}`?"
                if guess
                else "name another output of the same component, or a complete path",
                element=component_id,
            )
        return None


def _lay_over(given_words: _OutputWords, own: _OutputWords) -> _OutputWords:
    """Return what is said by itself, and for the rest what is passed on; of a promise key by key."""
    promise = own.promise or given_words.promise
    if own.promise and given_words.promise:
        kept: dict[str, Any] = {
            key: value for key, value in given_words.promise.list_kept() if getattr(own.promise, key) is None
        }
        if "unit" in kept and own.promise.range is not None:
            del kept["unit"]  # the unit of another range
        promise = replace(own.promise, **kept, places={**given_words.promise.places, **own.promise.places})
    return _OutputWords(promise, own.version or given_words.version, own.deprecated or given_words.deprecated)


def _join_promises(promises: Iterable[Promise | None]) -> Promise | None:
    """Return what all of several outputs promise alike."""
    first, *others = promises
    if first is None:
        return None
    differing: dict[str, Any] = {
        key: None
        for key in PROMISE_KEYS
        if any(_read_promised(each, key) != _read_promised(first, key) for each in others)
    }
    joined = replace(first, **differing)
    return joined if any(joined.list_kept()) else None


def _read_promised(promise: Promise | None, key: str) -> object:
    return getattr(promise, key) if promise else None
