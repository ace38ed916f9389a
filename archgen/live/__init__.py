"""A project that stays read while somebody works on it, with texts that are not saved."""
