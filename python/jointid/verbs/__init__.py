"""Public functions with one name per action. The subject selects the method: joint, servo, several joints, robot."""
