"""Schema: what may stand where, in our own words; short forms are taken out here."""
