// What the server has sent is never changed.

/** A type whose parts cannot be assigned. */
export type Immutable<T> = T extends (infer Entry)[]
  ? number extends T["length"]
    ? readonly Immutable<Entry>[]
    : { readonly [Index in keyof T]: Immutable<T[Index]> }
  : T extends object
    ? { readonly [Key in keyof T]: Immutable<T[Key]> }
    : T;
