"""What partners lose by a change, one module for each kind of loss.

Each has generators that take both versions (`change_context.ChangeContext`) and yield a `PartnerLoss` for each partner
and thing lost.
"""
