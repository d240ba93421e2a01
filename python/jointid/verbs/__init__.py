"""One verb an act: what it does depends on its subject, a joint, a servo, several joints or a robot."""
