"""A wall as a mason looks at it: rules that name stones and steps."""
