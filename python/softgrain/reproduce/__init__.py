"""The paper's figures by one command: `softgrain reproduce`. Nezamabadi et al., Powders & Grains 2017."""
