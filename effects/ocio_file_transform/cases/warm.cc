<ColorCorrection id="warm">
  <SOPNode><Slope>1.2 1 0.8</Slope><Offset>0.01 0 -0.01</Offset><Power>1 1.1 1.2</Power></SOPNode>
  <SatNode><Saturation>0.8</Saturation></SatNode>
</ColorCorrection>
