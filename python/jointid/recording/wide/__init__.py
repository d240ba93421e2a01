"""Several joints in one table: whose each column is, one joint of it, and all of them together."""
