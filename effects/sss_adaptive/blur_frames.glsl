// Frames of samples that the blurs stand for where there is no history. With 9 the first frame is nearer than the blurs on all
// three stills of docs/quality-sss-adaptive.md.
const float kFramesOfBlur = 9.0;
