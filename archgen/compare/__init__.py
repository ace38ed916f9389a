"""Compare two versions of an architecture: their models, findings and chains, never the lines of their files.

`match_elements` pairs renamed and moved elements first, `compared_elements` lists both versions in normal form under
common ids, and every difference then is a change (`difference_finder`), described by `change_sentences` with its
effects on connections (`connection_maps`).
"""

from archgen.compare.change import Break, ChainChange, Change, Comparison
from archgen.compare.compare import compare
from archgen.compare.version import Version

__all__ = ["Break", "ChainChange", "Change", "Comparison", "Version", "compare"]
