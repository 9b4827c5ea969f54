// Where an object stands in its parent's space, by numbers.
import { Euler, MathUtils, Matrix4, Quaternion, Vector3 } from 'three';
import type { SceneObject, Vector } from '../protocol/messages';
import { boxOf, matrixOf } from './tree';

function partsOf(object: SceneObject) {
  const matrix = matrixOf(object.transform);
  const position = new Vector3();
  const rotation = new Quaternion();
  matrix.decompose(position, rotation, new Vector3());
  return { matrix, position, rotation };
}

export function placementOf(object: SceneObject): { position: Vector; degrees: Vector } {
  const { position, rotation } = partsOf(object);
  const turn = new Euler().setFromQuaternion(rotation, 'XYZ');
  const clean = (x: number) => Number(Number(x.toPrecision(7)).toFixed(6)) + 0; // what is left of turning and back is no place
  return {
    position: [clean(position.x), clean(position.y), clean(position.z)],
    degrees: [turn.x, turn.y, turn.z].map((angle) => Number(MathUtils.radToDeg(angle).toFixed(4)) + 0) as Vector,
  };
}

export function movedTo(object: SceneObject, to: Vector): Matrix4 {
  return matrixOf(object.transform).setPosition(...to);
}

// Turned about the middle of its box to those angles, radians; stretching stays.
export function turnedTo(object: SceneObject, angles: Vector): Matrix4 {
  const { matrix, rotation } = partsOf(object);
  const turn = new Quaternion().setFromEuler(new Euler(...angles, 'XYZ')).multiply(rotation.invert());
  const middle = (object.bounds ? boxOf(object.bounds).getCenter(new Vector3()) : new Vector3()).applyMatrix4(matrix);
  return new Matrix4()
    .makeTranslation(middle)
    .multiply(new Matrix4().makeRotationFromQuaternion(turn))
    .multiply(new Matrix4().makeTranslation(middle.clone().negate()))
    .multiply(matrix);
}
