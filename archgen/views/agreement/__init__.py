"""Interface agreements: what flows between two partners, as a document that both can sign."""
