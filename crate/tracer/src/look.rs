//! The materials of surface points, mixed from those of elements, and the media behind them.
use crate::material::Look;
use crate::material::join_pieces;
use crate::media::Way;
use crate::rich::Rich;
use crate::soft::MakeUp;
use crate::world::{Owner, SurfacePoint, World};
use glam::DVec3;

impl World {
    /// Returns the material of a surface point.
    pub fn look(&self, rich: &Rich, hit: &SurfacePoint) -> Look {
        let materials = &rich.materials;
        let mut shares = Vec::new();
        let first = match self.owner_of(hit.surface) {
            Owner::Solid(number) => {
                let finish = self.solids.finish(number) as u32;
                if materials.is_even(finish) {
                    return materials.plain(finish, hit.normal);
                }
                shares.push((self.solids.element(number), finish, 1.0));
                finish
            }
            Owner::Soft(body) => {
                let MakeUp {
                    is_even,
                    first,
                    is_pieced,
                } = rich.make_up[body as usize];
                if is_even && materials.is_even(first) {
                    return materials.plain(first, hit.normal);
                }
                self.soft.shares(body, hit.position, &mut shares);
                if is_pieced {
                    join_pieces(&mut shares);
                }
                first
            }
            Owner::Other(number) => {
                self.others[number].shares(hit.position, &mut shares);
                let first = shares.first().map_or(0, |&(_, finish, _)| finish);
                join_pieces(&mut shares);
                first
            }
        };
        let mixed = materials.mix(&shares, hit.position, hit.normal);
        mixed.unwrap_or_else(|| materials.plain(first, hit.normal))
    }

    /// Returns the key of the medium behind or before a surface point, and the way a ray crosses
    /// there.
    pub fn medium(&self, rich: &Rich, hit: &SurfacePoint, direction: DVec3) -> (u32, Way) {
        if let Owner::Solid(number) = self.owner_of(hit.surface)
            && let Some(key) = rich.sheets[number as usize]
        {
            return (key, Way::Turn);
        }
        let enters = hit.normal.dot(direction) < 0.0;
        (hit.surface, if enters { Way::In } else { Way::Out })
    }
}
