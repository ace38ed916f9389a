"""Findings: diagnostics as text, JSON and more; the rules' pages."""
