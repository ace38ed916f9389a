"""What partners lose by a change, one module for each kind of loss.

Each is a generator that takes both versions (`both.Both`) and yields a `Loss` for each partner and each thing lost.
"""
