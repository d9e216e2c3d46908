//! Shows what the build script made of the scene: nothing of sdfc is left when the program runs.

mod bowl {
    include!(concat!(env!("OUT_DIR"), "/bowl.rs"));
}

fn main() {
    let params = bowl::Params { wall: 0.12, ..bowl::Params::default() };
    println!("group {}, binding {}: {:?}", bowl::GROUP, bowl::BINDING, params.to_bytes());
    println!("{} bytes of reflection, {} lists", bowl::REFLECTION.len(), bowl::LISTS.len());
    println!("{}", bowl::SHADER);
}
