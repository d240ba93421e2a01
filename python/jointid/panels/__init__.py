"""Pictures as data: what is drawn, from which both the reports and `jid.plot` draw."""
