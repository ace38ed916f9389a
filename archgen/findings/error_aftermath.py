"""Hold back findings that errors of reading and linking explain: what was not understood only seems to be missing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.diagnostics import Diagnostic

_WHOLE_MODEL_RULES = frozenset(
    {
        "borrowed-message",
        # Timing: one figure that could not be read changes the bounds of everything that shares a host with it.
        *("broken-chain", "broken-promise", "broken-step", "deadlocked-trigger", "endless-trigger", "late-chain"),
        *("lost-samples", "open-chain", "overloaded-host", "period-conflict", "saturated-link", "short-queue"),
        *("slow-component", "slow-service", "stale-input"),
        # What nothing refers to, and what nothing says: that may be what could not be read.
        *("disconnected-component", "empty-reference", "empty-view", "idle-executor", "missing-detail", "own-source"),
        *("uncovered-requirement", "unneeded-exception", "unmet-ready", "unlinked-hosts", "unmapped-component"),
        *("unpublished-output", "unread-output", "unset-parameter", "unsubscribed-input", "unused-type"),
        "unverified-requirement",
    }
)
"""Rules that judge the model as a whole: they wait until everything is read and linked."""
_LACK_RULES = frozenset(
    {
        *("absent-core", "circular-start", "half-written", "idle-timing", "incompatible-qos", "missing-property"),
        *("remote-resource", "role-mismatch", "silent-node", "two-clocks", "two-domains", "unfed-input"),
        *("unjustified-component", "unjustified-node", "unknown-message", "unmapped-type", "unlike-program"),
        *("unpublished-frame", "unstarted-program"),
    }
)
"""Rules that report what an element lacks (or that depend on a default or a `status: planned`): they wait for an element
in which something could not be read.
"""
_FILE_RULES = frozenset(
    {
        *("borrowed-call", "incompatible-qos", "misplaced-frame", "role-mismatch", "unaccounted-topic"),
        *("unchecked-message", "unjustified-node", "unknown-parameter", "unlisted-medium", "unmapped-type"),
        *("unnamed-source", "unpublished-frame", "unused-ros-setting", "wrong-section"),
    }
)
"""Rules that ask what another file may say of a type, a message or a topic: they wait while a whole file or section, or a
setting of the project, could not be read.
"""
AFTERMATH_RULES = _WHOLE_MODEL_RULES | _LACK_RULES | _FILE_RULES
"""All rules that may wait."""


def list_waiting_rules(errors: Iterable[Diagnostic], lost_keys: frozenset[str], *, is_partial: bool) -> frozenset[str]:
    """Return the rules that wait until these errors of reading and linking are mended.

    `lost_keys` are the keys of what could not be read: a rule whose setting is among them waits, lest what the project
    has switched off comes back. `is_partial` is whether a whole file or section could not be read.
    """
    errors = tuple(errors)
    if not is_partial and not errors:
        return frozenset()
    waiting_rules = _WHOLE_MODEL_RULES | lost_keys
    # An error in no element is one in the project's settings, such as its messages and shared topics.
    has_setting_error = any(error.element is None for error in errors)
    return waiting_rules | _FILE_RULES if is_partial or has_setting_error else waiting_rules


def drop_aftermath(
    diagnostics: Iterable[Diagnostic], errors: Iterable[Diagnostic], waiting_rules: frozenset[str]
) -> Iterator[Diagnostic]:
    """Yield the findings that wait for no error. The others return once the errors are mended.

    `errors` are those of reading: an element in which there is one seems to lack what they took.
    """
    damaged_elements = {error.element for error in errors if error.element}
    for diagnostic in diagnostics:
        is_explained_lack = diagnostic.rule in _LACK_RULES and diagnostic.element in damaged_elements
        if diagnostic.rule not in waiting_rules and not is_explained_lack:
            yield diagnostic
