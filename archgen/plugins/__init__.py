"""The plug-ins that ship, a folder each: code, templates, page. The core finds them here by `archgen.installed_plugins`.

A plug-in's `__init__.py` says what it brings in a mapping `PLUGIN`, and imports nothing: `archgen import --help` reads them all.
"""
