"""Compare two versions of an architecture: their models, findings and chains, never the lines of their files.

`kinds` says what elements of each kind have. `match_elements` pairs renamed and moved elements first, `change_listing`
lists both versions in normal form under common ids, and every difference then is a change, described by `change_sentences` with
its effects on connections (`version_pair`). It stops there; `compare_versions` goes on to what they break. `edits` says which
changes are one item to people.
"""

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.comparison import ChainChange, Change, Comparison, PartnerBreak

__all__ = ["ArchitectureVersion", "ChainChange", "Change", "Comparison", "PartnerBreak"]
