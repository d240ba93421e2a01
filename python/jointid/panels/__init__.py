"""Pictures as data. The reports and `jid.plot` draw them."""
