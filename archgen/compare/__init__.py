"""Compare two versions of an architecture: models, findings and chains, never lines.

`compare` finds what was renamed or moved first (`match`), lists both sides in normal form with one set of names
(`elements`), and what differs then is a change (`differences`), with its consequences (`wiring`) in words (`sentences`).
"""

from archgen.compare.change import Break, ChainChange, Change, Comparison
from archgen.compare.compare import compare
from archgen.compare.version import Version

__all__ = ["Break", "ChainChange", "Change", "Comparison", "Version", "compare"]
