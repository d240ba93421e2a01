"""Pictures as data, which both the reports and `jid.plot` draw."""
