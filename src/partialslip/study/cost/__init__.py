"""What accuracy costs: the study of cost, and the price list made from it."""
