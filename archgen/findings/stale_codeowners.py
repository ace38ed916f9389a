"""The rule about CODEOWNERS, the file beside the project that follows from it."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

STALE_CODEOWNERS = Rule(
    "stale-codeowners",
    Severity.WARNING,
    "A CODEOWNERS file that archgen wrote is no longer what follows from the owners in the architecture.",
    setting="rules: {stale-codeowners: note}  # off, note, warning or error",
)
