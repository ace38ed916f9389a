"""Renew the library of the site's search, uFuzzy, from the npm registry.

    python tools/vendor_search.py

To take another version, change VERSION and INTEGRITY (`npm view @leeoniya/ufuzzy@VERSION dist.integrity`) and the digests
in FILES, which it prints. The tests compare the committed files with FILES. It needs npm.
"""

from __future__ import annotations

import base64
import hashlib
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

PACKAGE = "@leeoniya/ufuzzy"
VERSION = "1.0.19"
INTEGRITY = "sha512-0pikDeYt0IHEUPza5RTCDXc/17S1pTrYnReEMp8Aa6k1ovzw5QdZLwicW8TjljwEZRb6oYag0xmALohrcq/yOQ=="
"""What the registry promises for the package, as in npm's lock files."""
FOLDER = Path(__file__).resolve().parent.parent / "backends" / "site" / "assets" / "search"
FILES = {
    "package/dist/uFuzzy.iife.min.js": (
        "ufuzzy.js",
        "3eef8ba0ad55444c31f0e86f8375f25916515402cf2d4d7b5a2c01b4b67f2e19",
    ),
    "package/LICENSE": ("LICENSE-uFuzzy.txt", "b43d07fcc08f2b2831cdf80bbff2102288222e8b5750b8f92b361dd6bf10dd17"),
}
"""The files that we take: their place in the package, their name here, their SHA-256."""


def main() -> int:
    """Write the files of the package; fail if the package or a file is not the one that is named here."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["npm", "pack", f"{PACKAGE}@{VERSION}", "--silent", "--pack-destination", folder]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        (archive,) = Path(folder).glob("*.tgz")
        if _hash_archive(archive) != INTEGRITY:
            print(f"{PACKAGE} {VERSION} is not what INTEGRITY says: {_hash_archive(archive)}")
            return 1
        _extract_files(archive)
    changed_files = list_changed_files()
    for name in changed_files:
        print(f"{name}: {hash_file(FOLDER / name)} is not the digest in FILES")
    return 1 if changed_files else 0


def list_changed_files() -> list[str]:
    """Return the names of the files that are not what FILES says."""
    return [name for name, digest in FILES.values() if hash_file(FOLDER / name) != digest]


def hash_file(path: Path) -> str:
    """Return the SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _hash_archive(path: Path) -> str:
    return f"sha512-{base64.b64encode(hashlib.sha512(path.read_bytes()).digest()).decode()}"


def _extract_files(path: Path) -> None:
    with tarfile.open(path) as archive:
        for member, (name, _) in FILES.items():
            content = archive.extractfile(member)
            if content is None:
                msg = f"{member} is not in the package"
                raise FileNotFoundError(msg)
            (FOLDER / name).write_bytes(content.read())


if __name__ == "__main__":
    sys.exit(main())
