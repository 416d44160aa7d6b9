//! Test of the memory for very many elements while a picture is made.
use field::{Bound, Primitive};
use scene::Element;

/// Elements that a picture may have.
const MANY: u64 = 1_000_000;
/// Bytes that it may take.
const ROOM: u64 = 3 << 29;

/// A scene holds an [`Element`] each, the tracer a [`Primitive`] and a [`Bound`]; before the bounds
/// are made, a second element in their place, which must not be larger. Besides, there are the
/// material (4 bytes), ball and number in the hierarchy (36), as much once more while it is sorted
/// (40), its nodes, at most half as many as elements (24). With 176 bytes for an element
/// or a bound and 440 for a primitive those are 10⁶ × (176 + 440 + 176 + 104) = 0.90·10⁹ bytes of
/// 1.61·10⁹; the rest is for the picture, the lists of a beam, the blob set (about 150 bytes each)
/// or the groups of others (not counted here), and the program itself.
#[test]
fn a_million_elements_leave_two_fifths_of_the_room_for_the_picture() {
    let [element, primitive, bound] = [
        size_of::<Element>(),
        size_of::<Primitive>(),
        size_of::<Bound>(),
    ];
    let lists = 4 + 36 + 40 + 24;
    let each = (element + primitive + element.max(bound) + lists) as u64;
    assert!(
        each * MANY * 5 <= ROOM * 3,
        "{each} bytes each: an element {element}, a primitive {primitive}, a bound {bound}"
    );
}
