"""Making a trial placement stable: support polyline, rotation, wedging (§3.7)."""
