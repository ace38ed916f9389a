"""The view `aadl`: the architecture as packages of AADL, as AADL writes them."""
