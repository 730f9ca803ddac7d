/* The newest points of a value, in memory that does not grow: of a full history, the oldest point is overwritten. */
class ValueHistory {
  static maxPoints = 6000;  /* ten minutes with ten changes a second */

  constructor() {
    this.times = new Float64Array(ValueHistory.maxPoints);
    this.values = new Float64Array(ValueHistory.maxPoints);
    this.count = 0;
    this.end = 0;
  }

  add(time, value) {
    this.times[this.end] = time;
    this.values[this.end] = value;
    this.end = (this.end + 1) % ValueHistory.maxPoints;
    this.count = Math.min(this.count + 1, ValueHistory.maxPoints);
  }

  inOrder(array) {
    if (this.count < ValueHistory.maxPoints || this.end === 0) return array.subarray(0, this.count);
    const all = new Float64Array(ValueHistory.maxPoints);
    all.set(array.subarray(this.end));
    all.set(array.subarray(0, this.end), ValueHistory.maxPoints - this.end);
    return all;
  }

  get data() {
    return [this.inOrder(this.times), this.inOrder(this.values)];
  }
}
