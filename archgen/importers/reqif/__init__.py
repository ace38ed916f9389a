"""Read requirements from ReqIF, as Doors, Polarion and their like exchange them."""
