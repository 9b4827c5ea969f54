// The ground that a studio puts under the model.
const studioGround = 'studio ground';

// Whether an object of that name is it: it stays when parts are isolated.
export const isGround = (name: string) => name === studioGround;
