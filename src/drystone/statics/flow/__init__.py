"""Coulomb friction without dilatancy: search for load multipliers, and the check of each."""
