"""Ways of choosing stones in the literature, as policies (docs/for-researchers.md)."""
