"""The robot that exists held against the design: what was observed of it, the rules that compare, what is accepted."""

from __future__ import annotations

from archgen.conformance.conformance_rules import RULES

__all__ = ["RULES"]
