"""Write requirements as ReqIF 1.2, for Doors, Polarion and their like."""

from archgen.emit.reqif.reqif_writer import render_reqif

__all__ = ["render_reqif"]
